"""MADQN: trained weights that drive in all four scenarios, see what they may see, and judge soundly."""

import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from worlds import Car, Junction, car

from codriving.animation.content import deliberated
from codriving.config.build import build
from codriving.config.compose import compose
from codriving.config.sweep import expand
from codriving.datatypes.record import Ending
from codriving.datatypes.world import Action
from codriving.environment.environment import Environment
from codriving.errors import WeightsError
from codriving.experiment.plan import make_plan
from codriving.geometry.road_map import road_map
from codriving.methods.learned.learned import Judged
from codriving.methods.learned.weights import load, save, shipped
from codriving.methods.madqn import Madqn

Make = Callable[..., Environment]
SCENARIOS = ("intersection", "roundabout", "highway", "merge")


def madqn(world: Junction, weights: Path | None = None) -> Madqn:
    made = Madqn(weights)
    made.reset(world.road_map, world.model, 0)
    return made


def judged(world: Junction, *cars: Car) -> Judged:
    return madqn(world).act(world.world(*cars))


def test_names_for_tables() -> None:
    made = build(compose(["method=madqn"])["method"], object)
    assert (made.name, made.variant, made.reasoner) == ("madqn", "", "none")


def steps(environment: Environment, made: Madqn, seed: int, most: int = 400) -> list[Judged]:
    world = environment.reset(seed)
    made.reset(environment.road_map, environment.driving_model, seed)
    found = []
    while environment.outcome is None and len(found) < most:
        found.append(made.act(world))
        assert set(found[-1].actions) == set(world.available)
        assert all(action in world.available[name] for name, action in found[-1].actions.items())
        world = environment.step(found[-1].actions)
    return found


@pytest.mark.parametrize("scenario", SCENARIOS)
def test_the_same_seed_gives_the_same_lines(scenario: str, configured: Make) -> None:
    environment, used = configured(f"scenario={scenario}"), Madqn(None)
    steps(environment, used, 10_001, 6)
    lines = [[s.as_dict() for s in steps(environment, made, 10_007, 6)] for made in (used, Madqn(None))]
    assert lines[0] == lines[1], "nothing is left of the episode before"
    assert json.loads(json.dumps(lines[0], allow_nan=False)) == lines[0]


def test_it_gets_every_vehicle_through_the_junction(configured: Make) -> None:
    environment = configured("scenario=intersection", "scenario.cavs=4", "scenario.hdvs=[0,0]")
    endings = []
    for seed in range(10_000, 10_004):
        steps(environment, Madqn(None), seed)
        assert environment.outcome is not None
        endings.append(environment.outcome.ending)
    assert endings.count(Ending.SUCCESS) >= 3


@pytest.mark.parametrize("route", ["south-north", "west-south", "north-west"])
@pytest.mark.parametrize("speed", [0.0, 3.0, 6.0])
def test_alone_on_the_road_it_goes(route: str, speed: float, junction: Junction) -> None:
    assert judged(junction, car("CAV1", route, 70.0, speed)).actions == {"CAV1": Action.FASTER}


def test_alone_on_a_lane_it_goes(highway: Junction) -> None:
    values = judged(highway, car("CAV1", "lane-1", 300.0, 20.0)).values["CAV1"]
    assert values[Action.FASTER] > max(values[Action.SLOWER], values[Action.IDLE])


@pytest.mark.parametrize("other", ["CAV2", "HDV1"])
@pytest.mark.parametrize("speed", [6.0, 7.5])
@pytest.mark.parametrize(("distance", "pace"), [(10.0, 2.0), (6.0, 0.0)])
def test_it_does_not_speed_up_before_a_zone_that_a_vehicle_is_in(
    other: str, speed: float, distance: float, pace: float, junction: Junction
) -> None:
    zone = junction.road_map.zones("south-north", "west-east")[0]
    ego = car("CAV1", "south-north", zone.entry_i - distance, speed)
    inside = car(other, "west-east", (zone.entry_j + zone.exit_j) / 2, pace)
    blocked, alone = (judged(junction, *cars).values["CAV1"] for cars in ((ego, inside), (ego,)))
    assert blocked[Action.FASTER] < max(blocked.values()), "something else is better"
    assert alone[Action.FASTER] > alone[Action.SLOWER]


def test_where_a_human_driver_is_bound_makes_no_difference(junction: Junction) -> None:
    ego = car("CAV1", "south-north", 85.0, 7.0)
    lines = [
        judged(junction, ego, car("HDV1", r, 85.0, 7.0)).as_dict() for r in ("west-north", "west-east", "west-south")
    ]
    assert lines[0] == lines[1] == lines[2]


def test_a_line_says_what_was_seen_and_what_each_action_is_worth(junction: Junction) -> None:
    world = junction.world(car("CAV1", "south-north", 80.0, 8.0), car("CAV2", "west-east", 80.0, 8.0))
    (one, _) = madqn(junction).act(world).as_dict()["cavs"]
    assert one["observed"]["slot1.crossing"] == 1
    assert one["observed"]["ego.straight"] == 1
    assert set(one["values"]) == {"SLOWER", "IDLE", "FASTER"}
    assert one["action"] == max(one["values"], key=one["values"].get)
    assert re.search(r"\d\.\d\d, against", one["reason"])


def test_replays_show_action_reason_and_route(junction: Junction) -> None:
    world = junction.world(car("CAV1", "south-north", 80.0, 8.0), car("CAV2", "west-east", 80.0, 8.0))
    shown = deliberated(madqn(junction).act(world).as_dict(), junction.road_map)
    assert shown.routes == {"CAV1": "south-north", "CAV2": "west-east"}
    assert shown.thoughts["CAV1"].action is not None
    assert "the network expects" in shown.thoughts["CAV1"].reason


def test_lane_changes_that_the_road_forbids_are_never_chosen(highway: Junction) -> None:
    world = highway.world(car("CAV1", "lane-0", 200.0, 25.0), car("HDV1", "lane-0", 215.0, 15.0))
    found = madqn(highway).act(world)
    assert Action.LANE_LEFT not in found.values["CAV1"]
    narrow = replace(world, available={"CAV1": (Action.SLOWER, Action.IDLE, Action.FASTER)})
    assert madqn(highway).act(narrow).actions["CAV1"] in narrow.available["CAV1"]


def test_a_world_without_cavs_asks_for_nothing(junction: Junction) -> None:
    assert judged(junction, car("HDV1", "south-north", 60.0, 7.0)).actions == {}
    assert judged(junction).as_dict()["cavs"] == []


@pytest.mark.parametrize(
    ("tokens", "words"),
    [
        (("scenario.decision_frequency=5",), "set scenario.decision_frequency=2"),
        (("scenario.target_speeds=[0,4.5,9]",), "step of target speeds"),
        (("scenario=highway", "scenario.lanes=1", "scenario.hdvs=[0,2]"), "highest target speed"),
    ],
)
def test_roads_that_it_was_not_trained_for_are_refused_before_anything_is_driven(
    tokens: tuple[str, ...], words: str
) -> None:
    with pytest.raises(WeightsError, match=re.escape(words)):
        make_plan(expand(["method=madqn", "launcher=serial", *tokens]))


def test_weights_of_ones_own(tmp_path: Path, junction: Junction, highway: Junction) -> None:
    trained = load(shipped("madqn", "junction", limited=False))
    file = tmp_path / "mine.safetensors"
    save(file, trained)
    made = madqn(junction, file)
    assert made.variant == "own weights"
    world = junction.world(car("CAV1", "south-north", 80.0, 8.0))
    assert made.act(world).values == madqn(junction).act(world).values
    with pytest.raises(WeightsError, match="family junction"):
        madqn(highway, file)
    save(file, replace(trained, purpose=replace(trained.purpose, method="ppo")))
    with pytest.raises(WeightsError, match="weights of ppo"):
        Madqn(file)
    with pytest.raises(WeightsError, match=r"nowhere\.json"):
        Madqn(tmp_path / "nowhere.safetensors")


@pytest.mark.parametrize("family", ["junction", "lanes"])
def test_shipped_weights_in_numpy_and_torch_agree(family: str) -> None:
    torch = pytest.importorskip("torch")
    network = load(shipped("madqn", family, limited=True)).network
    rng = np.random.default_rng(0)
    observations = rng.uniform(-1, 1, (2000, network.weights[0].shape[0])).astype(np.float32)
    hidden = torch.from_numpy(observations)
    for k, (weight, bias) in enumerate(zip(network.weights, network.biases, strict=True)):
        hidden = torch.nn.functional.linear(hidden, torch.from_numpy(weight.T.copy()), torch.from_numpy(bias))
        if k < len(network.weights) - 1:
            hidden = torch.relu(hidden)
    # Outputs reach 30, and in float32 the order in which a kernel adds 128 products decides the seventh digit.
    np.testing.assert_allclose(network(observations), hidden.numpy(), rtol=1e-5, atol=2e-5)


@pytest.mark.parametrize("scenario", ["intersection", "merge"])
def test_weights_of_another_world_are_marked(scenario: str, configured: Make) -> None:
    road = configured(f"scenario={scenario}").scenario.road
    for limits, drivers, others in (("none", "simulator", "rough"), ("road", "mixed", "attentive")):
        assert Madqn(None).remark(road, {"limits": limits, "drivers": drivers}) == ""
        said = f"madqn: its weights were trained in another world, limits={limits} drivers={drivers}."
        assert Madqn(None).remark(road, {"limits": limits, "drivers": others}) == said


def test_vehicles_without_limits_have_weights_of_their_own(configured: Make) -> None:
    names = {}
    for suite in ("paper", "default"):
        environment, made = configured("scenario=intersection", f"suite={suite}"), Madqn(None)
        names[suite] = made.files(environment.scenario.road, suite == "default")["weights"].parent.name
        first = steps(environment, made, 10_001, 1)[0].values
        assert first == steps(environment, Madqn(shipped("madqn", "junction", suite == "default")), 10_001, 1)[0].values
        assert first != steps(environment, Madqn(shipped("madqn", "junction", suite == "paper")), 10_001, 1)[0].values
    assert names == {"paper": "paper", "default": "default"}


def test_every_scenario_has_weights_for_its_road_and_pace(configured: Make) -> None:
    for scenario in SCENARIOS:
        made, environment = Madqn(None), configured(f"scenario={scenario}")
        made.check_road(environment.scenario.road, environment.driving_model.target_speeds, 0.5)
        made.reset(road_map(environment.scenario.road), environment.driving_model, 0)
