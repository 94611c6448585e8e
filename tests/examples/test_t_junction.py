"""The example of the docs: its road, its scenes, and that all CAVs arrive on it."""

import importlib.util
import inspect
import math
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
import yaml
from worlds import Junction

from codriving.config.build import build
from codriving.config.choices import describe
from codriving.config.compose import compose
from codriving.datatypes.record import Ending
from codriving.datatypes.world import Action
from codriving.environment.environment import Environment
from codriving.errors import ConfigError
from codriving.experiment.objects import make_objects
from codriving.scenarios import Kind, Start, Turn

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "t_junction"
FILE = FOLDER / "conf" / "scenario" / "t_junction.yaml"
NODE: dict[str, Any] = yaml.safe_load(FILE.read_text(encoding="utf-8"))


@pytest.fixture
def module(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The module of the example, importable by its name for this test alone."""
    spec = importlib.util.spec_from_file_location("t_junction", FOLDER / "t_junction.py")
    assert spec is not None
    assert spec.loader is not None
    made = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "t_junction", made)
    spec.loader.exec_module(made)
    return made


@pytest.fixture
def environment(module: ModuleType) -> Environment:
    """The example's road to drive on."""
    config = compose(["scenario=t_junction"], FOLDER / "conf")
    made = build(config["environment"], object, "environment", config["plugins"])
    assert isinstance(made, Environment)
    assert type(made.scenario) is module.TJunction
    return made


def test_yaml_sets_every_argument_and_says_what_it_is(module: ModuleType) -> None:
    assert set(inspect.signature(module.TJunction).parameters) == set(NODE) - {"_target_", "plugins"}
    assert describe(FILE).endswith(".")
    lines = FILE.read_text(encoding="utf-8").splitlines()
    assert all("  # " in line for line in lines if not line.startswith(("#", "_target_")))


def test_three_legs_make_six_routes_that_end_past_the_junction(environment: Environment) -> None:
    road = environment.road_map.road
    turns = {route.id: route.turn for route in road.routes}
    assert turns == {
        "west-east": Turn.STRAIGHT,
        "east-west": Turn.STRAIGHT,
        "west-south": Turn.RIGHT,
        "east-south": Turn.LEFT,
        "south-east": Turn.RIGHT,
        "south-west": Turn.LEFT,
    }
    for route in road.routes:
        across = {Turn.STRAIGHT: 22.0, Turn.RIGHT: 9 * math.pi / 2, Turn.LEFT: 13 * math.pi / 2}[route.turn]
        assert route.entry == pytest.approx(100.0)
        assert route.goal == pytest.approx(100.0 + across + 25.0)
        path = environment.road_map.paths[route.id]
        assert path.length == pytest.approx(200.0 + across)
        assert np.abs(np.diff(path.headings)).max() < 0.06, "lanes meet without a kink"


def test_settings_out_of_range_are_refused(module: ModuleType) -> None:
    node = {key: value for key, value in NODE.items() if key != "plugins"}
    for change, message in (
        ({"cavs": 10}, "scenario.cavs must be 2 to 9, got 10"),
        ({"leg_length": 10.0}, "scenario.leg_length must be 40 to 500 m, got 10"),
        ({"start": [20.0, 25.0]}, "4 CAVs and up to 4 HDVs cannot start within 20 to 25 m along 3 legs"),
    ):
        with pytest.raises(ConfigError, match=message):
            build({**node, **change}, object, "scenario", ["t_junction"])


def test_the_side_road_gives_way(environment: Environment) -> None:
    world = Junction(environment).drive(
        Start("CAV1", Kind.CAV, "east-west", 0.0, 1.0),
        Start("HDV1", Kind.HDV, "west-east", 60.0, 8.0),
        Start("HDV2", Kind.HDV, "south-west", 60.0, 8.0),
    )
    world.reset(0)
    for _ in range(20):
        world.step({"CAV1": Action.IDLE})
    main, side = (track for track in world.trajectory().tracks if track.id != "CAV1")
    assert main.speed.min() > 7.0
    assert side.speed.min() < 4.0


@pytest.mark.parametrize("seed", [10000, 10001, 10002])
def test_all_cavs_arrive(environment: Environment, seed: int) -> None:
    method = make_objects(compose(["scenario=t_junction"], FOLDER / "conf")).method
    world = environment.reset(seed)
    method.reset(environment.road_map, environment.driving_model, seed)
    while environment.outcome is None:
        world = environment.step(method.act(world).actions)
    assert environment.outcome.ending is Ending.SUCCESS
