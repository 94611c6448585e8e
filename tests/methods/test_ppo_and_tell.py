"""PPO and TeLL: policies of a single vehicle drive on every road, see nothing hidden, and say how sure they are."""

import json
import re
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from driven import Episode, drive
from hidden import scrambled
from worlds import Junction, car

from codriving.animation.content import deliberated
from codriving.config.build import build
from codriving.config.compose import compose
from codriving.config.sweep import expand
from codriving.config.training import compose_training
from codriving.datatypes.record import Ending
from codriving.datatypes.world import Action
from codriving.environment.environment import Environment
from codriving.errors import WeightsError
from codriving.experiment.plan import make_plan
from codriving.methods.learned.layout import FAMILIES
from codriving.methods.learned.learned import Learned
from codriving.methods.learned.weights import load, save, shipped
from codriving.methods.ppo import Ppo
from codriving.methods.tell import Tell
from codriving.training.folder import fingerprint

Make = Callable[..., Environment]
SCENARIOS = ("intersection", "roundabout", "highway", "merge")
METHODS: dict[str, type[Learned]] = {"ppo": Ppo, "tell": Tell}
DECISIONS = 14

IN_PAPER = Path(__file__).parents[2] / "examples" / "paper_world" / "conf"
"""What the weights for vehicles without limits were trained with."""


def made(name: str) -> Learned:
    return METHODS[name](None)


@pytest.mark.parametrize(("name", "variant"), [("ppo", ""), ("tell", "taught by rules")])
def test_names_for_tables(name: str, variant: str) -> None:
    method = build(compose([f"method={name}"])["method"], object)
    assert (method.name, method.variant, method.reasoner) == (name, variant, "none")


@pytest.fixture(scope="module")
def driven(configured: Make) -> Callable[[str, str], Episode]:
    """The first decisions of each policy on each road, driven once."""

    @cache
    def once(scenario: str, name: str) -> Episode:
        return drive(configured(f"scenario={scenario}"), made(name), 10_003, decisions=DECISIONS)

    return once


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("scenario", SCENARIOS)
def test_hidden_routes_intents_and_kinds_change_no_decision(
    scenario: str, name: str, configured: Make, driven: Callable[[str, str], Episode]
) -> None:
    junction, episode = Junction(configured(f"scenario={scenario}")), driven(scenario, name)
    rng = np.random.default_rng(1)
    ego = episode.worlds[0].cavs[0].id
    guesses = made(name)
    guesses.reset(junction.road_map, junction.model, 10_003)
    compared = 0
    for world, one in zip(episode.worlds, episode.steps, strict=False):
        if ego in world.intents:
            hidden = scrambled(world, ego, junction.road_map, rng)
            other = guesses.act(hidden)
            assert one.observations[ego].tobytes() == other.observations[ego].tobytes()
            assert one.actions[ego] is other.actions[ego]
            compared += hidden.intents != world.intents
    assert compared >= DECISIONS


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("scenario", SCENARIOS)
def test_the_same_seed_gives_the_same_lines(
    scenario: str, name: str, configured: Make, driven: Callable[[str, str], Episode]
) -> None:
    environment, used = configured(f"scenario={scenario}"), made(name)
    drive(environment, used, 10_008, decisions=4)
    episodes = drive(environment, used, 10_003, decisions=DECISIONS), driven(scenario, name)
    lines = [[step.as_dict() for step in episode.steps] for episode in episodes]
    assert lines[0] == lines[1], "nothing is left of the episode before"
    assert json.loads(json.dumps(lines[0], allow_nan=False)) == lines[0]
    for world, line in zip(episodes[0].worlds, lines[0], strict=False):
        for cav in line["cavs"]:
            shares = cav["probabilities"]
            assert set(shares) <= {str(action) for action in world.available[cav["id"]]}
            assert sum(shares.values()) == pytest.approx(1.0, abs=1e-4)
            assert cav["action"] == max(shares, key=shares.get)


@pytest.mark.parametrize("name", METHODS)
def test_it_gets_several_through_the_junction(name: str, configured: Make) -> None:
    environment = configured("scenario=intersection", "scenario.cavs=2", "scenario.hdvs=[0,1]")
    endings = [drive(environment, made(name), seed).outcome for seed in range(10_000, 10_006)]
    assert sum(o is not None and o.ending is Ending.SUCCESS for o in endings) >= 4


@pytest.mark.parametrize("name", METHODS)
def test_a_line_and_a_replay_say_how_sure_it_is(name: str, junction: Junction) -> None:
    method = made(name)
    method.reset(junction.road_map, junction.model, 0)
    world = junction.world(car("CAV1", "south-north", 80.0, 8.0), car("CAV2", "west-east", 80.0, 8.0))
    line = method.act(world).as_dict()
    (one, _) = line["cavs"]
    assert set(one["probabilities"]) == {"SLOWER", "IDLE", "FASTER"}
    assert re.search(r"the policy prefers \w+: \d+%, against", one["reason"])
    assert one["observed"]["slot1.there"] == 1
    assert "slot1.is_cav" not in one["observed"], "it cannot tell who drives"
    shown = deliberated(line, junction.road_map)
    assert shown.routes == {"CAV1": "south-north", "CAV2": "west-east"}
    assert "the policy prefers" in shown.thoughts["CAV1"].reason


@pytest.mark.parametrize("name", METHODS)
def test_lane_changes_that_the_road_forbids_are_never_chosen(name: str, highway: Junction) -> None:
    method = made(name)
    method.reset(highway.road_map, highway.model, 0)
    world = highway.world(car("CAV1", "lane-0", 200.0, 25.0), car("HDV1", "lane-0", 215.0, 15.0))
    assert Action.LANE_LEFT not in method.act(world).values["CAV1"]
    assert method.act(highway.world(car("HDV1", "lane-0", 200.0, 20.0))).actions == {}


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize(
    ("tokens", "words"),
    [
        (("scenario.decision_frequency=5",), "set scenario.decision_frequency=2"),
        (("scenario.target_speeds=[0,4.5,9]",), "step of target speeds"),
    ],
)
def test_roads_that_it_was_not_trained_for_are_refused_before_anything_is_driven(
    name: str, tokens: tuple[str, ...], words: str
) -> None:
    with pytest.raises(WeightsError, match=re.escape(words)):
        make_plan(expand([f"method={name}", "launcher=serial", *tokens]))


def test_weights_of_ones_own_say_who_taught(tmp_path: Path, junction: Junction) -> None:
    trained = load(shipped("tell", "junction", limited=False))
    file = tmp_path / "mine.safetensors"
    by_model = {**trained.purpose.training, "teacher": "ollama_chat/llama3.1:8b"}
    save(file, replace(trained, purpose=replace(trained.purpose, training=by_model)))
    method = Tell(file)
    assert method.variant == "own weights, taught by ollama_chat/llama3.1:8b"
    method.reset(junction.road_map, junction.model, 0)
    world = junction.world(car("CAV1", "south-north", 80.0, 8.0))
    reference = made("tell")
    reference.reset(junction.road_map, junction.model, 0)
    assert method.act(world).values == reference.act(world).values
    with pytest.raises(WeightsError, match="weights of tell, not of ppo"):
        Ppo(file)


@pytest.mark.parametrize(
    ("name", "limited", "configs"),
    [
        ("madqn", True, None),
        ("madqn", False, IN_PAPER),
        ("ppo", True, None),
        ("ppo", False, IN_PAPER),
        ("tell", True, None),
        ("tell", False, IN_PAPER),
    ],
)
@pytest.mark.parametrize("family", FAMILIES)
def test_shipped_weights_say_how_they_were_trained(name: str, family: str, limited: bool, configs: Path | None) -> None:
    file = shipped(name, family, limited)
    purpose = load(file).purpose
    assert (purpose.method, purpose.family) == (name, family)
    assert purpose.training["command"] == f"codriving train {name} --family {family}"
    config = compose_training(f"{name}_{family}", (), smoke=False, config_dir=configs)
    assert purpose.training["config"] == fingerprint(config), "trained with the shipped config"
    assert purpose.training["validation"]["first_seed"] >= 10_000
    curve = file.with_suffix(".csv").read_text().splitlines()
    assert curve[0].startswith("decisions,")
    assert any(line.startswith(f"{purpose.training['decisions']},") for line in curve), "the state that was chosen"
    assert file.stat().st_size < 200_000
