"""What a frame shows, read from stored decisions and trajectories."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from crossing import crossing, episode, line, swapped
from hypothesis import given
from hypothesis import strategies as st

from codriving.animation.content import FrameContent, StoredFrames, deliberated
from codriving.datatypes.order import Severity
from codriving.datatypes.record import Trajectory
from codriving.datatypes.world import Action

ROADS = crossing()
KEYS = ("time", "cavs", "id", "action", "reason", "scene", "intent", "route", "conflicts", "order", "sequence")
FURTHER = ("precedences", "first", "second", "ego", "other", "severity", "dttcp", "routes", "zone", "relation")
leaves = (
    st.none() | st.booleans() | st.integers(-3, 99) | st.floats(allow_nan=False) | st.sampled_from(["CAV1", "east"])
)
things = st.recursive(
    leaves,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from((*KEYS, *FURTHER)), inner, max_size=6),
    max_leaves=12,
)


def test_a_line_of_ours_is_read_in_full() -> None:
    read = deliberated(line(1.5), ROADS)
    assert read.time == 1.5
    assert read.thoughts["CAV2"].action is Action.SLOWER
    assert read.thoughts["CAV2"].reason == "lets it pass"
    assert read.thoughts["CAV2"].waits_for == ("HDV1",)
    assert read.thoughts["CAV1"].waits_for == ()
    assert read.routes == {"CAV1": "east", "CAV2": "east"}
    assert read.order == ("HDV1", "CAV1", "CAV2")
    (meeting,) = read.meetings
    assert (meeting.one, meeting.other, meeting.severity, meeting.certain) == ("CAV2", "HDV1", Severity.SERIOUS, False)
    assert meeting.ways == (("east", pytest.approx(30.0, abs=0.5)), ("south", pytest.approx(30.0, abs=0.5)))


def test_of_a_pair_the_worst_is_kept() -> None:
    entry = line(0.0)
    slight = swapped(entry["cavs"][1]["conflicts"][0], ego="HDV1", other="CAV2", dttcp=6.0, severity="slight danger")
    entry["cavs"][0]["conflicts"] = [slight]
    (meeting,) = deliberated(entry, ROADS).meetings
    assert meeting.dttcp == 1.2


def test_orders_of_their_own_are_no_common_order() -> None:
    entry = line(0.0)
    entry["cavs"][1]["order"] = swapped(entry["cavs"][1]["order"], sequence=["CAV2", "HDV1"])
    read = deliberated(entry, ROADS)
    assert read.order is None
    assert "own" in read.order_title


def test_an_order_that_binds_says_so() -> None:
    entry = line(0.0)
    for cav in entry["cavs"]:
        cav["order"] = swapped(cav["order"], binding=True)
    assert "binding" in deliberated(entry, ROADS).order_title


@pytest.mark.parametrize("changes", [{"zone": 7}, {"routes": ["east", "nowhere"]}, {"relation": "following"}])
def test_a_conflict_without_a_place_on_the_map_is_still_one(changes: dict[str, Any]) -> None:
    (meeting,) = deliberated(line(0.0, **changes), ROADS).meetings
    assert meeting.ways is None


@pytest.mark.parametrize(
    "entry", [{}, {"cavs": None}, {"cavs": [{"id": "CAV1"}]}, {"cavs": [7]}, {"time": 3.0, "x": 1}]
)
def test_a_line_of_another_method_is_no_error(entry: dict[str, Any]) -> None:
    assert deliberated(entry, ROADS).meetings == ()


@given(st.dictionaries(st.sampled_from((*KEYS, *FURTHER)), things, max_size=6))
def test_whatever_stands_there_is_no_error(entry: dict[str, Any]) -> None:
    deliberated(entry, ROADS)


@given(things, st.sampled_from(sorted(line(0.0)["cavs"][1]["conflicts"][0])))
def test_a_broken_conflict_is_no_error(value: object, key: str) -> None:
    deliberated(line(0.0, **{key: value}), ROADS)


TRAJECTORY, OUTCOME = episode()
REPLAY = StoredFrames(crossing(), TRAJECTORY, [line(0.0), line(1.0, dttcp=4.0, severity="general danger")], OUTCOME)


def ids(moment: FrameContent) -> list[str]:
    return [body.id for body in moment.bodies]


@given(st.floats(0.0, 2.0))
def test_positions_lie_between_those_of_the_steps(time: float) -> None:
    car = next(body for body in REPLAY.at(time).bodies if body.id == "CAV1")
    assert car.x == pytest.approx(30.0 + 10.0 * time - 30.0, abs=1e-6)
    assert car.speed == pytest.approx(10.0)


def test_who_has_arrived_has_left_the_road() -> None:
    assert ids(REPLAY.at(2.0)) == ["CAV1", "CAV2", "HDV1"]
    later = REPLAY.at(2.1)
    assert ids(later) == ["CAV2", "HDV1"]
    assert later.arrived == {"CAV1": 2.0}
    assert REPLAY.at(1.9).arrived == {}


def test_decisions_hold_until_the_next_ones() -> None:
    assert [REPLAY.at(time).meetings[0].dttcp for time in (0.0, 0.99, 1.0, 2.5)] == [1.2, 1.2, 4.0, 4.0]


def test_the_outcome_is_known_only_at_the_end() -> None:
    assert REPLAY.duration == pytest.approx(3.0)
    assert REPLAY.at(2.99).outcome is None
    assert REPLAY.at(3.0).outcome == OUTCOME
    assert REPLAY.at(99.0) == REPLAY.at(3.0)


def test_only_cavs_have_a_plan() -> None:
    routes = {body.id: body.route for body in REPLAY.at(0.0).bodies}
    assert routes == {"CAV1": "east", "CAV2": "east", "HDV1": None}


def test_without_decisions_the_actions_of_the_trajectory_are_shown() -> None:
    bare = StoredFrames(crossing(), TRAJECTORY, [], OUTCOME)
    moment = bare.at(1.0)
    assert moment.thoughts["CAV1"].action is Action.FASTER
    assert moment.meetings == ()
    assert bare.at(0.0).thoughts["CAV1"].action is Action.FASTER
    assert "HDV1" not in moment.thoughts


def test_a_heading_turns_the_short_way() -> None:
    first = TRAJECTORY.tracks[0]
    spun = replace(first, heading=np.where(np.arange(len(first.x)) % 2, np.pi - 0.01, -np.pi + 0.01))
    replay = StoredFrames(crossing(), Trajectory(0.1, (spun,)), [], OUTCOME)
    assert abs(np.cos(replay.at(0.05).bodies[0].heading)) == pytest.approx(1.0, abs=1e-3)


def test_one_row_is_enough() -> None:
    first = TRAJECTORY.tracks[0]
    short = replace(first, **{name: getattr(first, name)[:1] for name in ("x", "y", "heading", "speed", "action")})
    moment = StoredFrames(crossing(), Trajectory(0.1, (short,)), [], OUTCOME).at(0.0)
    assert (ids(moment), moment.outcome) == (["CAV1"], OUTCOME)


def test_who_comes_later_is_not_there_before() -> None:
    late = replace(TRAJECTORY.tracks[0], first_step=10)
    replay = StoredFrames(crossing(), Trajectory(0.1, (late, TRAJECTORY.tracks[1])), [], OUTCOME)
    assert ids(replay.at(0.9)) == ["CAV2"]
    assert ids(replay.at(1.0)) == ["CAV1", "CAV2"]
