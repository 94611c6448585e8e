"""Time to collision and the braking that avoids it, worked out by hand."""

import numpy as np
import pytest

from codriving.datatypes.record import Track, Trajectory
from codriving.datatypes.world import Kind
from codriving.metrics.following import closest


def _track(
    name: str, x: float, speed: float, y: float = 0.0, heading: float = 0.0, kind: Kind = Kind.CAV, first: int = 0
) -> Track:
    """Two rows, 0.1 s apart, at constant speed."""
    way = np.array([0.0, 0.1]) * speed
    xs, ys, same = x + way * np.cos(heading), y + way * np.sin(heading), np.ones(2)
    return Track(name, kind, "r", first, xs, ys, heading * same, speed * same, 0 * same, ("IDLE",) * 2, None)


def test_one_behind_another_by_hand() -> None:
    """Centres are 25 m apart, so bumpers 20 m; 15 against 10 m/s: after 0.1 s 19.5 m at 5 m/s.

    TTC = 19.5 / 5 = 3.9 s, DRAC = 5^2 / (2 x 19.5) = 0.641 m/s2.
    """
    found = closest(Trajectory(0.1, (_track("a", 0, 15), _track("b", 25, 10, kind=Kind.HDV))))
    assert found == (pytest.approx(3.9), pytest.approx(0.641, abs=5e-4))


@pytest.mark.parametrize(
    "other",
    [
        _track("b", 25, 15),
        _track("b", 25, 20),
        _track("b", 25, 10, y=4),
        _track("b", 25, 10, heading=np.pi),
        _track("b", 25, 10, first=2),
    ],
    ids=["as fast", "faster", "on the next lane", "oncoming", "later"],
)
def test_nothing_where_none_runs_into_the_one_ahead(other: Track) -> None:
    assert closest(Trajectory(0.1, (_track("a", 0, 15), other))) == (None, None)


def test_human_drivers_among_themselves_do_not_count() -> None:
    pair = _track("a", 0, 15, kind=Kind.HDV), _track("b", 25, 10, kind=Kind.HDV)
    assert closest(Trajectory(0.1, pair)) == (None, None)
    assert closest(Trajectory(0.1, (*pair, _track("c", 200, 10, y=40)))) == (None, None)


def test_one_that_comes_over_counts_as_soon_as_it_is_in_the_way() -> None:
    """At y = 1.9 m the bodies of 2 m overlap by 0.1 m; at 2.1 m they do not."""
    assert closest(Trajectory(0.1, (_track("a", 0, 15), _track("b", 25, 10, y=1.9)))).ttc == pytest.approx(3.9)
    assert closest(Trajectory(0.1, (_track("a", 0, 15), _track("b", 25, 10, y=2.1)))).ttc is None
