"""When one CAV can be where at the earliest."""

from dataclasses import replace

import numpy as np
import pytest

from codriving.bound.envelope import Envelope
from codriving.bound.passing import Passing
from codriving.datatypes import Kind, Route, Start, Turn
from codriving.errors import ScenarioError

FLAT = np.zeros(40)
ENVELOPE = Envelope(0.0, np.where(np.arange(40) < 20, 10.0, 5.0), FLAT, FLAT, FLAT, FLAT)


def passing(alone: list[float], speed: float = 8.0, lead: float = 0.0) -> Passing:
    route = Route("a", (), Turn.STRAIGHT, 10.0, 30.0)
    start = Start("CAV1", Kind.CAV, "a", alone[0], speed)
    return Passing(start, route, np.array(alone), replace(ENVELOPE, lead=lead), 1.0, 8.0)


def test_least_time_is_that_of_the_pace_of_each_metre() -> None:
    cav = passing([0.0, 10.0, 20.0, 30.0])
    assert np.diff(cav.least_time(np.array([0.0, 10.0, 25.0]))) == pytest.approx([1.0, 2.0])
    # At 16 m/s it starts twice as fast as its highest target.
    assert passing([0.0, 10.0, 20.0, 30.0], 16.0).least_time(np.array([20.0])) == pytest.approx([1.0])
    assert passing([0.0, 10.0, 20.0, 30.0], 16.0).fastest == 20.0


def test_earliest_is_that_of_the_drive_alone_less_the_lead_and_no_less_than_the_pace_allows() -> None:
    cav = passing([0.0, 4.0, 12.0, 18.0, 24.0, 31.0], lead=0.2)
    assert cav.earliest(np.array([4.0, 8.0])) == pytest.approx([0.8, 1.3])
    # It is at 30 m after 2 s and 2 s at 10 and at 5 m/s, if it had been as fast as the pace from the start on.
    assert passing([0.0, 20.0, 30.0]).earliest(np.array([30.0])) == pytest.approx([4.0])
    assert cav.earliest(np.array([0.0])) == pytest.approx([0.0])


def test_arrival_is_seen_at_the_next_look_and_may_be_a_look_earlier_within_the_lead() -> None:
    # Alone it is at the goal, 30 m, after 5.1 s.
    drive = [0.0, 4.0, 12.0, 18.0, 24.0, 29.0, 39.0]
    assert (passing(drive).arrival, passing(drive).least_arrival) == (6.0, 6.0)
    assert passing(drive, lead=0.05).least_arrival == 6.0
    assert passing(drive, lead=0.15).least_arrival == 5.0


def test_who_does_not_arrive_alone_has_no_bound() -> None:
    with pytest.raises(ScenarioError, match="CAV1 does not arrive within the time limit even if it is alone"):
        passing([0.0, 10.0, 29.0])
