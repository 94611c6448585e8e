"""Methods for a single vehicle: what they must not know changes nothing, and each drives on every road."""

import json
from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
from driven import Episode, drive
from hidden import scrambled
from worlds import Junction, car

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.record import Ending
from codriving.datatypes.world import Start
from codriving.environment.environment import Environment
from codriving.methods.single_vehicle.method import SingleVehicle
from codriving.runs.json_files import lines_text

Make = Callable[..., Environment]

SCENARIOS = ("intersection", "roundabout", "highway", "merge")
METHODS = ("pidm", "noncoop_game")
DECISIONS = 14


def made(name: str) -> SingleVehicle:
    method = build(compose([f"method={name}"])["method"], object)
    assert isinstance(method, SingleVehicle)
    return method


@pytest.mark.parametrize("name", METHODS)
def test_names_for_tables(name: str) -> None:
    method = made(name)
    assert (method.name, method.variant, method.reasoner) == (name, "", "none")


@pytest.fixture(scope="module")
def driven(configured: Make) -> Callable[[str, str], Episode]:
    """Each method on each road to the end, driven once."""

    @cache
    def once(scenario: str, name: str) -> Episode:
        return drive(configured(f"scenario={scenario}"), made(name), 10_004)

    return once


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("scenario", SCENARIOS)
def test_hidden_routes_intents_and_kinds_change_no_decision(
    scenario: str, name: str, configured: Make, driven: Callable[[str, str], Episode]
) -> None:
    junction, episode = Junction(configured(f"scenario={scenario}")), driven(scenario, name)
    rng = np.random.default_rng(1)
    compared = 0
    for ego in (cav.id for cav in episode.worlds[0].cavs[:2]):
        guesses = made(name)
        guesses.reset(junction.road_map, junction.model, 10_004)
        for world, knows in zip(episode.worlds[:DECISIONS], episode.steps, strict=False):
            if ego not in world.intents:
                break
            hidden = scrambled(world, ego, junction.road_map, rng)
            assert _of(guesses.act(hidden), ego) == _of(knows, ego)
            compared += hidden.intents != world.intents
    assert compared > DECISIONS


def _of(step: object, ego: str) -> tuple[object, object]:
    decisions, situations = step.decisions, step.situations  # type: ignore[attr-defined]
    (k,) = [k for k, d in enumerate(decisions) if d.ego == ego]
    return decisions[k], situations[k]


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("scenario", SCENARIOS)
def test_the_same_seed_gives_the_same_bytes_and_every_line_is_strict_json(
    scenario: str, name: str, configured: Make, driven: Callable[[str, str], Episode]
) -> None:
    environment, used = configured(f"scenario={scenario}"), made(name)
    drive(environment, used, 10_008, decisions=4)
    episodes = drive(environment, used, 10_004, decisions=DECISIONS), driven(scenario, name)
    lines = [[step.as_dict() for step in episode.steps[:DECISIONS]] for episode in episodes]
    assert lines_text("", lines[0]) == lines_text("", lines[1]), "nothing is left of the episode before"
    for world, step, line in zip(episodes[0].worlds, episodes[0].steps, lines[0], strict=False):
        assert json.loads(json.dumps(line, allow_nan=False)) == line
        for cav, decision in zip(line["cavs"], step.decisions, strict=True):
            assert decision.action in world.available[decision.ego]
            assert str(decision.action) in cav["allowed"]
            assert set(cav["allowed"]) | set(cav["removed"]) == {str(a) for a in world.available[decision.ego]}
            assert cav["reason"]
            assert cav["order"]["binding"] is False
            assert all(p["reason"] for p in cav["order"]["precedences"])


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("scenario", SCENARIOS)
def test_each_road_is_driven_to_the_end(scenario: str, name: str, driven: Callable[[str, str], Episode]) -> None:
    outcome = driven(scenario, name).outcome
    assert outcome is not None
    assert outcome.ending is Ending.SUCCESS


@pytest.mark.parametrize("name", METHODS)
def test_cavs_alone_do_not_run_into_one_another(name: str, configured: Make) -> None:
    environment = configured("scenario=intersection", "scenario.hdvs=[0,0]", "scenario.cavs=6")
    endings = [outcome.ending for seed in range(10_100, 10_106) if (outcome := _end(environment, name, seed))]
    assert endings.count(Ending.COLLISION) == 0
    assert endings.count(Ending.SUCCESS) >= 5


def _end(environment: Environment, name: str, seed: int) -> object:
    return drive(environment, made(name), seed).outcome


@pytest.mark.parametrize("name", METHODS)
def test_four_at_once_do_not_wait_for_one_another_for_ever(name: str, junction: Junction) -> None:
    legs = ("south", "west", "north", "east")
    starts = [car(f"CAV{k}", f"{leg}-{legs[(k + 2) % 4]}", 60.0, 7.0) for k, leg in enumerate(legs)]
    environment = junction.drive(*(Start(c.id, c.kind, c.route, c.place, c.speed) for c in starts))
    outcome = drive(environment, made(name), 0).outcome
    assert outcome is not None
    assert outcome.ending is Ending.SUCCESS


@pytest.mark.parametrize("name", METHODS)
def test_no_vehicle_is_in_conflict_with_a_vehicle_it_cannot_see(name: str, junction: Junction) -> None:
    method = made(name)
    method.reset(junction.road_map, junction.model, 0)
    step = method.act(junction.world(car("CAV1", "south-north", 30.0, 6.0), car("CAV2", "west-east", 30.0, 6.0)))
    assert [s.conflicts for s in step.situations] == [(), ()]
    assert [s.order.sequence for s in step.situations] == [(), ()]
