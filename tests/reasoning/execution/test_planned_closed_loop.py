"""CAVs among themselves, driven to the end: none is hit, none waits for ever, none overtakes the order."""

from collections.abc import Callable
from itertools import combinations

import numpy as np
import pytest
from driven import Episode, drive, ordered
from thorough import THOROUGH
from worlds import Junction

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.record import Ending, Track
from codriving.datatypes.world import Action, Kind, Start
from codriving.environment.environment import Environment
from codriving.geometry.box import TRUE
from codriving.geometry.path import progress
from codriving.geometry.road_map import RoadMap
from codriving.methods.ordered import Ordered
from codriving.reasoning.conflicts import is_open

Make = Callable[..., Environment]
EPISODES = {"fcfs": 20, "idfst": 6, "mcts": 6} if THOROUGH else {"fcfs": 8, "idfst": 4, "mcts": 4}
FIRST_SEED = 10_000
ALONE = "scenario.hdvs=[0,0]"


def method(name: str, *overrides: str) -> Ordered:
    made = build(compose([f"method={name}", *overrides])["method"], object)
    assert isinstance(made, Ordered)
    return made


@pytest.fixture(scope="module")
def four(configured: Make) -> Environment:
    return configured("scenario=intersection", "scenario.cavs=4", ALONE)


@pytest.fixture(scope="module")
def driven(four: Environment) -> dict[str, list[Episode]]:
    """Episodes of four CAVs at the intersection, by rule."""
    rules = {name: method(name) for name in EPISODES}
    return {n: [drive(four, rules[n], FIRST_SEED + k) for k in range(count)] for n, count in EPISODES.items()}


@pytest.mark.parametrize("name", EPISODES)
def test_cavs_alone_arrive(name: str, driven: dict[str, list[Episode]]) -> None:
    endings = [e.outcome.ending if e.outcome else None for e in driven[name]]
    assert len(endings) == EPISODES[name]
    assert endings.count(Ending.SUCCESS) >= 0.95 * len(endings), endings


@pytest.mark.parametrize("name", EPISODES)
def test_every_vehicle_has_a_plan_all_the_time(name: str, driven: dict[str, list[Episode]]) -> None:
    # What is planned with the exact vehicle model can be gone on with: CAVs alone lose no plan that works.
    without = [step.counts["plans_infeasible"] for e in driven[name] for step in e.steps]
    assert sum(without) <= 0.01 * len(without)


@pytest.mark.parametrize("name", EPISODES)
def test_no_vehicle_is_told_what_the_road_forbids(name: str, driven: dict[str, list[Episode]]) -> None:
    for episode in driven[name]:
        for world, actions in zip(episode.worlds, episode.actions, strict=False):
            assert set(actions) == set(world.available)
            assert all(action in world.available[cav] for cav, action in actions.items())


def test_no_vehicle_becomes_faster_than_the_top_speed(four: Environment, driven: dict[str, list[Episode]]) -> None:
    top = four.driving_model.target_speeds[-1]
    assert all(t.speed.max() <= top + 1e-6 for es in driven.values() for e in es for t in e.trajectory.tracks)


def along(track: Track, road_map: RoadMap) -> np.ndarray:
    return progress(road_map.paths[track.route], track.x, track.y, track.heading)


def entered(s: np.ndarray, entry: float) -> float:
    """The step at which a vehicle enters a zone; inf if it never does."""
    return float(np.argmax(s > entry)) if (s > entry).any() else np.inf


def decided(episode: Episode, one: str, other: str) -> set[str]:
    """Who of two was said to go first, at any time."""
    said = {s.order.first_of(one, other) for step in episode.steps for s in step.situations}
    return {name for name in said if name is not None}


@pytest.mark.parametrize("name", EPISODES)
def test_no_vehicle_overtakes_the_order(name: str, four: Environment, driven: dict[str, list[Episode]]) -> None:
    checked = 0
    road_map = four.road_map
    for episode in driven[name]:
        tracks = {t.id: (t, along(t, road_map)) for t in episode.trajectory.tracks}
        for one, other in combinations(sorted(tracks), 2):
            said = decided(episode, one, other)
            if len(said) != 1:
                continue
            (first,) = said
            second = other if first == one else one
            (t1, s1), (t2, s2) = tracks[first], tracks[second]
            for zone in road_map.zones(t1.route, t2.route, TRUE):
                if is_open(zone, s1[0], s2[0]):
                    assert entered(s1, zone.entry_i) < entered(s2, zone.entry_j), (episode.steps[0], first, second)
                    checked += 1
    assert checked >= 2 * EPISODES[name], "hardly a pair met"


@pytest.mark.parametrize("name", EPISODES)
def test_the_same_seed_gives_the_same_actions(name: str, four: Environment, driven: dict[str, list[Episode]]) -> None:
    before = driven[name][1]
    again = drive(four, method(name), FIRST_SEED + 1)
    assert again.actions == before.actions
    assert [t.x.tobytes() for t in again.trajectory.tracks] == [t.x.tobytes() for t in before.trajectory.tracks]


@pytest.mark.parametrize("executor", ["planned", "layered"])
@pytest.mark.parametrize("route", ["south-north", "south-west", "south-east"])
def test_a_lone_cav_accelerates_all_the_way(executor: str, route: str, junction: Junction) -> None:
    environment = junction.drive(Start("CAV1", Kind.CAV, route, 60.0, 5.0))
    episode = drive(environment, method("fcfs", f"executor={executor}"), 0)
    assert episode.outcome is not None
    assert episode.outcome.ending is Ending.SUCCESS
    assert episode.actions == [{"CAV1": Action.FASTER}] * len(episode.steps)


def test_those_whose_ways_do_not_meet_do_not_wait(junction: Junction) -> None:
    environment = junction.drive(
        Start("CAV1", Kind.CAV, "south-north", 60.0, 7.0), Start("CAV2", Kind.CAV, "north-south", 60.0, 7.0)
    )
    episode = drive(environment, ordered(junction), 0)
    assert all(set(actions.values()) == {Action.FASTER} for actions in episode.actions)


@pytest.mark.parametrize(("name", "cavs", "seeds"), [("fcfs", 8, 2), ("idfst", 8, 1), ("mcts", 8, 1), ("fcfs", 6, 1)])
def test_no_vehicle_waits_for_ever(name: str, cavs: int, seeds: int, configured: Make) -> None:
    environment = configured("scenario=intersection", f"scenario.cavs={cavs}", ALONE, "scenario.time_limit=60")
    for seed in range(FIRST_SEED, FIRST_SEED + seeds):
        outcome = drive(environment, method(name), seed).outcome
        assert outcome is not None
        assert outcome.ending is Ending.SUCCESS, (seed, outcome)


@pytest.mark.parametrize("scenario", ["roundabout", "highway", "merge"])
def test_it_goes_on_in_every_scenario(scenario: str, configured: Make) -> None:
    environment = configured(f"scenario={scenario}", "scenario.hdvs=[0,0]")
    outcome = drive(environment, method("fcfs"), FIRST_SEED).outcome
    assert outcome is not None
    assert outcome.ending is Ending.SUCCESS, outcome


def test_the_layered_executor_brings_every_vehicle_there_later(
    four: Environment, driven: dict[str, list[Episode]]
) -> None:
    slow = [drive(four, method("fcfs", "executor=layered"), FIRST_SEED + k).outcome for k in range(3)]
    fast = [e.outcome for e in driven["fcfs"][:3]]
    assert all(o is not None and o.ending is Ending.SUCCESS for o in slow)
    mean = [np.mean([t for o in some if o for t in o.arrivals.values()]) for some in (fast, slow)]
    assert mean[0] < mean[1]
