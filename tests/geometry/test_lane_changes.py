"""Routes that change lanes: the way over, where lanes begin on it, and what is refused."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from codriving.datatypes.road import Arc, Lane, LaneShape, Road, Route, Straight, Turn, beside
from codriving.errors import ScenarioError
from codriving.geometry.curve import first_part, lane_curve, taper
from codriving.geometry.lane_path import end_of, lane_starts, route_path
from codriving.geometry.road_map import RoadMap


def _lane(index: int, y: float, length: float = 100.0) -> Lane:
    return Lane(("a", "b", index), Straight((0.0, y), (length, y)))


ON = Lane(("b", "c", 0), Straight((100.0, 0.0), (160.0, 0.0)))


@settings(deadline=None)
@given(length=st.floats(10, 90), aside=st.floats(2, 6), right=st.booleans())
def test_a_taper_leaves_and_joins_in_the_direction_of_the_lanes(length: float, aside: float, right: bool) -> None:
    y = aside if right else -aside
    curve = taper(lane_curve(_lane(0, 0.0).shape), lane_curve(_lane(1, y).shape), length)
    assert end_of(curve, at_start=True) == pytest.approx((100.0 - length, 0.0, 0.0), abs=2e-3)
    assert end_of(curve, at_start=False) == pytest.approx((100.0, y, 0.0), abs=2e-3)
    points, headings = curve.at(np.linspace(0.0, curve.length, 2001))
    assert (np.diff(points[:, 0]) > 0).all()
    assert (np.diff(np.abs(points[:, 1])) > -1e-9).all()
    # Half a cosine is steepest in its middle, with pi / 2 times the mean slope.
    steepest = math.atan(math.pi / 2 * aside / length)
    assert np.abs(headings).max() == pytest.approx(steepest, abs=2e-3)
    chords = np.hypot(*np.diff(points, axis=0).T)
    assert chords.sum() == pytest.approx(curve.length, rel=1e-4)
    np.testing.assert_allclose(chords, curve.length / 2000, rtol=0.01)


def test_a_taper_follows_lanes_that_bend() -> None:
    outer, inner = Arc((0.0, 0.0), 40.0, 0.0, 1.5), Arc((0.0, 0.0), 36.0, 0.0, 1.5)
    curve = taper(lane_curve(outer), lane_curve(inner), 30.0)
    assert end_of(curve, at_start=True) == pytest.approx(end_of(first_part(lane_curve(outer), 30.0), False), abs=5e-3)
    assert end_of(curve, at_start=False) == pytest.approx(end_of(lane_curve(inner), at_start=False), abs=5e-3)
    radii = np.hypot(*curve.at(np.linspace(0.0, curve.length, 100))[0].T)
    assert (np.diff(radii) < 1e-9).all()


def test_first_part_is_the_same_curve_but_shorter() -> None:
    whole = lane_curve(Arc((0.0, 0.0), 40.0, 0.0, 1.5))
    part = first_part(whole, 20.0)
    assert part.length == 20.0
    s = np.linspace(0.0, 20.0, 9)
    for ours, theirs in zip(part.at(s), whole.at(s), strict=True):
        np.testing.assert_array_equal(ours, theirs)


@pytest.mark.parametrize("change", [10.0, 40.0, 100.0])
def test_the_lane_that_is_changed_to_begins_in_the_middle_of_the_taper(change: float) -> None:
    lanes = [_lane(1, 4.0), _lane(0, 0.0), ON]
    path, starts = route_path(lanes, change), lane_starts(lanes, change)
    over = taper(lane_curve(lanes[0].shape), lane_curve(lanes[1].shape), change).length
    assert starts == pytest.approx((0.0, 100.0 - change + over / 2, 100.0 - change + over))
    assert path.length == pytest.approx(100.0 - change + over + 60.0)
    assert path.position(starts[1])[1] == pytest.approx(2.0, abs=0.05), "between the two lanes"
    assert path.position(starts[2]) == pytest.approx((100.0, 0.0), abs=0.02)
    assert path.position(100.0 - change) == pytest.approx((100.0 - change, 4.0), abs=0.02)
    assert np.hypot(*np.diff(path.points, axis=0).T).max() <= path.spacing + 1e-6


def test_lanes_one_after_the_other_are_no_change() -> None:
    assert beside(("a", "b", 0), ("a", "b", 1))
    assert not beside(("a", "b", 0), ("a", "b", 0))
    assert not beside(("a", "b", 0), ("b", "c", 1))


def _road(*lanes: Lane, taper: float = 40.0) -> Road:
    route = Route("over", tuple(lane.id for lane in lanes), Turn.STRAIGHT, 0.0, 50.0, taper)
    return Road("wide", lanes, (route,))


THREE = (_lane(2, 8.0), _lane(1, 4.0), _lane(0, 0.0))


@pytest.mark.parametrize(
    ("road", "complaint"),
    [
        (_road(*THREE, ON), r"changes lanes from \('a', 'b', 2\) to \('a', 'b', 1\) to \('a', 'b', 0\); between two"),
        (_road(THREE[0], THREE[2], ON), "which are not next to each other; change one lane at a time"),
        (_road(*THREE[1:], ON, taper=100.5), "a taper of 100.5 m; it must be 10 m to the 100.0 m of the lane that is"),
        (_road(*THREE[1:], ON, taper=9.0), "a taper of 9 m; it must be 10 m to the 100.0 m"),
    ],
)
def test_lane_changes_that_cannot_be_driven_are_refused(road: Road, complaint: str) -> None:
    with pytest.raises(ScenarioError, match=complaint):
        RoadMap(road)


def test_a_change_in_each_of_two_sections_can_be_driven() -> None:
    shapes: list[tuple[str, str, int, LaneShape]] = [
        ("a", "b", 0, Straight((0.0, 0.0), (100.0, 0.0))),
        ("a", "b", 1, Straight((0.0, 4.0), (100.0, 4.0))),
        ("b", "c", 0, Straight((100.0, 0.0), (200.0, 0.0))),
        ("b", "c", 1, Straight((100.0, 4.0), (200.0, 4.0))),
    ]
    lanes = tuple(Lane((start, end, index), shape) for start, end, index, shape in shapes)
    way = (lanes[0].id, lanes[1].id, lanes[3].id, lanes[2].id)
    road = RoadMap(Road("weave", lanes, (Route("over", way, Turn.STRAIGHT, 0.0, 150.0, 30.0),)))
    assert road.paths["over"].position(100.0)[1] == pytest.approx(4.0, abs=0.1)
    assert road.paths["over"].points[-1] == pytest.approx((200.0, 0.0))
    first, second = road.changes.ahead("over", 0.0), road.changes.ahead("over", 103.0)
    assert first == (way[1], pytest.approx(85.0, abs=1.0), pytest.approx(100.0, abs=1.0))
    assert second == (way[3], pytest.approx(185.0, abs=1.0), pytest.approx(200.0, abs=1.0))


def test_a_taper_may_take_all_of_the_lane() -> None:
    road = RoadMap(_road(*THREE[1:], ON, taper=100.0))
    assert road.paths["over"].points[0] == pytest.approx((0.0, 4.0))
    assert RoadMap(replace(road.road, name="again")).paths["over"].length == road.paths["over"].length
