"""Moments of a stored episode: positions between two steps, decisions as they stood."""

from dataclasses import replace

import numpy as np
import pytest
from crossing import crossing, episode, line
from hypothesis import given
from hypothesis import strategies as st

from codriving.animation.moment import Moment
from codriving.animation.replay import Replay
from codriving.datatypes.action import Action
from codriving.datatypes.trajectory import Trajectory

TRAJECTORY, OUTCOME = episode()
REPLAY = Replay(crossing(), TRAJECTORY, [line(0.0), line(1.0, dttcp=4.0, severity="general danger")], OUTCOME)


def ids(moment: Moment) -> list[str]:
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
    bare = Replay(crossing(), TRAJECTORY, [], OUTCOME)
    moment = bare.at(1.0)
    assert moment.thoughts["CAV1"].action is Action.FASTER
    assert moment.meetings == ()
    assert bare.at(0.0).thoughts["CAV1"].action is Action.FASTER
    assert "HDV1" not in moment.thoughts


def test_a_heading_turns_the_short_way() -> None:
    first = TRAJECTORY.tracks[0]
    spun = replace(first, heading=np.where(np.arange(len(first.x)) % 2, np.pi - 0.01, -np.pi + 0.01))
    replay = Replay(crossing(), Trajectory(0.1, (spun,)), [], OUTCOME)
    assert abs(np.cos(replay.at(0.05).bodies[0].heading)) == pytest.approx(1.0, abs=1e-3)


def test_one_row_is_enough() -> None:
    first = TRAJECTORY.tracks[0]
    short = replace(first, **{name: getattr(first, name)[:1] for name in ("x", "y", "heading", "speed", "action")})
    moment = Replay(crossing(), Trajectory(0.1, (short,)), [], OUTCOME).at(0.0)
    assert (ids(moment), moment.outcome) == (["CAV1"], OUTCOME)


def test_who_comes_later_is_not_there_before() -> None:
    late = replace(TRAJECTORY.tracks[0], first_step=10)
    replay = Replay(crossing(), Trajectory(0.1, (late, TRAJECTORY.tracks[1])), [], OUTCOME)
    assert ids(replay.at(0.9)) == ["CAV2"]
    assert ids(replay.at(1.0)) == ["CAV1", "CAV2"]
