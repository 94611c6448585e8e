"""What is written down of a decision step."""

import json
import math
from collections.abc import Callable
from dataclasses import asdict, is_dataclass, replace
from typing import Any

import pytest
from worlds import Junction, car

from codriving.datatypes.situation import ReasonedDeliberation
from codriving.methods.codriving import CoDriving

Make = Callable[..., CoDriving]


@pytest.fixture(scope="module")
def step(method: Make, junction: Junction) -> ReasonedDeliberation:
    """A step in which a vehicle stands in the way, so that a clear time is infinite, and actions are removed."""
    world = junction.world(
        car("CAV1", "south-north", 93.0, 6.0),
        car("CAV2", "west-north", 90.0, 6.0),
        car("HDV1", "west-east", 112.0, 0.0),
        time=1.5,
        step=3,
    )
    return method().act(world)


def test_a_line_is_strict_json(step: ReasonedDeliberation) -> None:
    line = step.as_dict()
    assert json.loads(json.dumps(line, allow_nan=False)) == line
    assert any(c["clear_time"] is None for cav in line["cavs"] for c in cav["conflicts"])


def test_a_line_holds_what_was_told_removed_ordered_and_decided(step: ReasonedDeliberation) -> None:
    line = step.as_dict()
    assert (line["time"], line["step"]) == (1.5, 3)
    assert [cav["id"] for cav in line["cavs"]] == ["CAV1", "CAV2"]
    for cav, situation, decision in zip(line["cavs"], step.situations, step.decisions, strict=True):
        assert (cav["action"], cav["reason"]) == (decision.action, decision.reason)
        assert cav["reason"]
        assert cav["action"] in cav["allowed"]
        assert [n["id"] for n in cav["scene"]["neighbours"]] == [n.id for n in situation.scene.neighbours]
        assert cav["scene"]["neighbours"][0]["x"] == pytest.approx(situation.scene.neighbours[0].x, abs=1e-6)
        assert {c["other"] for c in cav["conflicts"]} == {c.other for c in situation.conflicts}
        assert all({"ttcp", "dttcp", "severity", "relation", "clear_time"} <= set(c) for c in cav["conflicts"])
        assert cav["order"]["sequence"] == list(situation.order.sequence)
        assert all(p["reason"] for p in cav["order"]["precedences"])
        assert set(cav["allowed"]) | set(cav["removed"]) == {a.action for a in situation.assessments}
        assert not set(cav["allowed"]) & set(cav["removed"])
        assert [a["action"] for a in cav["assessments"]] == [a.action for a in situation.assessments]
        assert cav["memories"] == []
    assert any(reasons for cav in line["cavs"] for reasons in cav["removed"].values())


def as_plain(value: Any) -> Any:
    """What `dataclasses.asdict` makes of a record, with rounded numbers."""
    if is_dataclass(value) and not isinstance(value, type):
        return as_plain(asdict(value))
    if isinstance(value, dict):
        return {key: as_plain(v) for key, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [as_plain(v) for v in value]
    if isinstance(value, float):
        return round(value, 6) if math.isfinite(value) else None
    return str(value) if isinstance(value, str) else value


def test_a_line_is_what_asdict_would_make_of_it(step: ReasonedDeliberation) -> None:
    for cav, situation in zip(step.as_dict()["cavs"], step.situations, strict=True):
        told = [
            {**as_plain(c), "clear_time": as_plain(t)}
            for c, t in zip(situation.conflicts, situation.clear_times, strict=True)
        ]
        scene = as_plain(situation.scene)
        # Nothing is told where messages are exact, and a line does not say so.
        assert {neighbour.pop("told") for neighbour in scene["neighbours"]} == {None}
        assert json.dumps(cav["scene"]) == json.dumps(scene)
        assert json.dumps(cav["conflicts"]) == json.dumps(told)
        assert json.dumps(cav["assessments"]) == json.dumps(as_plain(situation.assessments))
        assert json.dumps(cav["order"]["precedences"]) == json.dumps(as_plain(situation.order.precedences))


@pytest.mark.parametrize("odd", [math.nan, math.inf, -math.inf])
def test_what_is_no_number_is_written_as_null(odd: float, step: ReasonedDeliberation) -> None:
    first, *others = step.situations
    told = replace(first, clear_times=(odd,) * len(first.conflicts), scene=replace(first.scene, place=odd))
    line = replace(step, situations=(told, *others)).as_dict()
    assert json.loads(json.dumps(line, allow_nan=False)) == line
    assert line["cavs"][0]["scene"]["place"] is None
    assert {c["clear_time"] for c in line["cavs"][0]["conflicts"]} == {None}


def test_a_forced_action_keeps_its_reasons(method: Make, junction: Junction) -> None:
    world = junction.world(car("CAV1", "south-north", 60.0, 9.0), car("HDV1", "south-north", 67.0, 0.0))
    (cav,) = method().act(world).as_dict()["cavs"]
    (forced,) = [a for a in cav["assessments"] if a["safe"]]
    assert cav["allowed"] == [forced["action"]]
    assert any("least dangerous" in reason for reason in forced["reasons"])


def test_actions_are_by_vehicle(step: ReasonedDeliberation) -> None:
    assert step.actions == {d.ego: d.action for d in step.decisions}


def test_the_same_world_is_thought_of_in_the_same_way(method: Make, junction: Junction) -> None:
    def think(**change: Any) -> list[dict[str, Any]]:
        made = method(seed=4, **change)
        world = junction.environment.reset(4)
        lines = []
        for _ in range(4):
            deliberation = made.act(world)
            lines.append(deliberation.as_dict())
            world = junction.environment.step(deliberation.actions)
        return lines

    for change in ({}, {"negotiation": False, "own_order": "independent"}):
        assert think(**change) == think(**change)
