"""The example of a rule of one's own: it is built from its YAML, orders by distance, and drives."""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.record import Ending
from codriving.experiment.objects import make_objects
from codriving.ordering import ApproachingVehicle, Instance

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "nearest_first"
PAGE = Path(__file__).resolve().parents[2] / "docs" / "methods" / "README.md"


@pytest.fixture
def config(monkeypatch: pytest.MonkeyPatch) -> Iterator[dict[str, Any]]:
    monkeypatch.syspath_prepend(str(FOLDER))
    yield compose(["method=nearest_first", "scenario.hdvs=[0,0]"], FOLDER / "conf")
    sys.modules.pop("nearest_first", None)


def test_it_orders_by_distance_and_keeps_what_is_fixed(config: dict[str, Any]) -> None:
    rule = build(config["method"], object, "method", config["plugins"]).rule
    far, near = (
        ApproachingVehicle("CAV1", 100.0, 5.0, distance=40.0),
        ApproachingVehicle("CAV2", 100.0, 4.0, distance=20.0),
    )
    instance = Instance(0.0, {"CAV1": far, "CAV2": near}, {("CAV1", "CAV2"): 2.0, ("CAV2", "CAV1"): 2.0}, set())
    assert rule.order(instance, None).sequence == ("CAV2", "CAV1")
    assert rule.order(instance, None).times == {"CAV2": 4.0, "CAV1": 6.0}
    fixed = Instance(0.0, instance.vehicles, instance.separation, {("CAV1", "CAV2")})
    assert rule.order(fixed, None).sequence == ("CAV1", "CAV2")


def test_it_drives_an_episode(config: dict[str, Any]) -> None:
    environment, method, *_ = make_objects(config)
    world = environment.reset(10_000)
    method.reset(environment.road_map, environment.driving_model, 10_000)
    while environment.outcome is None:
        world = environment.step(method.act(world).actions)
    assert environment.outcome.ending is Ending.SUCCESS


def test_it_orders_for_codriving(config: dict[str, Any]) -> None:
    resolved = compose(["order=nearest_first", "order.step=2.0"], FOLDER / "conf")
    assert resolved["plugins"] == ["nearest_first"]
    assert resolved["order"]["step"] == 2.0
    assert config["method"]["rule"] == {**resolved["order"], "step": 5.0}
    assert make_objects(resolved).method.variant == "order=nearest_first"


def test_the_page_quotes_the_rule() -> None:
    source = (FOLDER / "nearest_first.py").read_text(encoding="utf-8")
    quoted = PAGE.read_text(encoding="utf-8").split("```python\n")[1].split("```")[0]
    assert all(line.strip() in source for line in quoted.splitlines())
