"""Conflict zones: their limits, their tables, their mirror image."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from codriving.datatypes.order import Relation
from codriving.datatypes.road import Arc, Lane, Straight
from codriving.geometry.box import PLANNING, TRUE, Footprint, separation
from codriving.geometry.curve import FloatArray
from codriving.geometry.find_zones import find_zones
from codriving.geometry.lane_path import lane_path
from codriving.geometry.path import Path
from codriving.geometry.road_map import RoadMap
from codriving.geometry.zone import Band, ConflictZone, FollowingBand, following_zone

GRAZE = 0.1


def _straight(x: float, y: float, heading: float, length: float = 80.0) -> Path:
    dx, dy = math.cos(heading) * length / 2, math.sin(heading) * length / 2
    return lane_path(Lane(("a", "b", 0), Straight((x - dx, y - dy), (x + dx, y + dy))))


def _depth(path_i: Path, path_j: Path, s_i: FloatArray, s_j: FloatArray, footprint: Footprint) -> FloatArray:
    """Overlap depth (n, m) [m] at all pairs of places."""
    a, b = np.meshgrid(s_i, s_j, indexing="ij")
    heading, turn = path_i.heading(a), path_j.heading(b) - path_i.heading(a)
    dx, dy = (q - p for p, q in zip(path_i.position(a), path_j.position(b), strict=True))
    cos, sin = np.cos(heading), np.sin(heading)
    return -separation(cos * dx + sin * dy, cos * dy - sin * dx, np.cos(turn), np.sin(turn), footprint)


def _deepest_unreported(
    path_i: Path, path_j: Path, zones: tuple[ConflictZone, ...], footprint: Footprint, seed: int
) -> float:
    """Depth of the deepest overlap among placements that every zone calls free [m]."""
    rng = np.random.default_rng(seed)
    s_i, s_j = rng.uniform(0, path_i.length, 300), rng.uniform(0, path_j.length, 300)
    # Most of the draws where it matters: in and around a zone.
    for zone in zones:
        s_i[:200] = np.clip(rng.uniform(zone.entry_i - 2, zone.exit_i + 2, 200), 0, path_i.length)
        s_j[:200] = np.clip(rng.uniform(zone.entry_j - 2, zone.exit_j + 2, 200), 0, path_j.length)
    free = np.ones((300, 300), dtype=bool)
    for zone in zones:
        free &= (s_i[:, None] > zone.front(s_j)) | (s_i[:, None] < zone.back(s_j))
    return float(_depth(path_i, path_j, s_i, s_j, footprint)[free].max())


def test_south_straight_against_west_straight(intersection: RoadMap) -> None:
    # Two footprints of 5 x 2 m at right angles overlap within 3.5 m of the crossing of the centre lines.
    (zone,) = intersection.zones("south-north", "west-east", TRUE)
    assert zone.relation is Relation.CROSSING
    assert (zone.point_i, zone.point_j) == pytest.approx((109, 113), abs=0.3)
    assert (zone.entry_i, zone.exit_i) == pytest.approx((105.5, 112.5), abs=0.01)
    assert (zone.entry_j, zone.exit_j) == pytest.approx((109.5, 116.5), abs=0.01)
    assert zone.merge_i is zone.merge_j is zone.split_i is zone.split_j is None


@given(st.floats(0.25, math.pi - 0.25), st.floats(-1, 1))
@settings(deadline=None)
def test_limits_of_skew_crossings_are_exact(angle: float, shift: float) -> None:
    (zone,) = find_zones(_straight(0, shift, 0), _straight(0, 0, angle), TRUE)
    # Minkowski sum of the two boxes, cut along the direction of either path.
    half = (TRUE.length + TRUE.length * abs(math.cos(angle)) + TRUE.width * math.sin(angle)) / 2
    slide = (TRUE.width + TRUE.length * math.sin(angle) + TRUE.width * abs(math.cos(angle))) / 2 / math.sin(angle)
    corner = slide * abs(math.cos(angle)) + half
    assert zone.exit_i - zone.entry_i <= 2 * corner + 1e-6
    assert zone.exit_i - zone.entry_i == pytest.approx(zone.exit_j - zone.entry_j, abs=0.6)
    assert (zone.entry_i + zone.exit_i) / 2 == pytest.approx(40 + shift / math.tan(angle), abs=0.3)


@given(st.floats(0.2, math.pi - 0.2), st.floats(-2, 2), st.sampled_from([TRUE, PLANNING]), st.integers(0, 99))
@settings(max_examples=25, deadline=None)
def test_a_placement_called_free_is_free_on_straight_paths(
    angle: float, shift: float, footprint: Footprint, seed: int
) -> None:
    i, j = _straight(0, shift, 0.1), _straight(0, 0, angle)
    assert _deepest_unreported(i, j, find_zones(i, j, footprint), footprint, seed) < GRAZE


@given(st.floats(8, 40), st.floats(-12, 12), st.floats(-12, 12), st.booleans(), st.integers(0, 99))
@settings(max_examples=25, deadline=None)
def test_a_placement_called_free_is_free_on_arcs(radius: float, x: float, y: float, clockwise: bool, seed: int) -> None:
    end = 2.0 if clockwise else -2.0
    arc = lane_path(Lane(("a", "b", 0), Arc((x, y - radius), radius, 0.0, end, clockwise)))
    line = _straight(x, y, 0.4)
    assert _deepest_unreported(line, arc, find_zones(line, arc, PLANNING), PLANNING, seed) < GRAZE


@pytest.mark.parametrize("footprint", [TRUE, PLANNING])
@pytest.mark.parametrize("network", ["intersection", "roundabout"])
def test_a_placement_called_free_is_free_on_roads(
    network: str, footprint: Footprint, request: pytest.FixtureRequest
) -> None:
    road: RoadMap = request.getfixturevalue(network)
    one = sorted(road.paths)[0]
    for other in sorted(road.paths)[1:]:
        zones = road.zones(one, other, footprint)
        assert _deepest_unreported(road.paths[one], road.paths[other], zones, footprint, 1) < GRAZE


def test_the_tables_are_not_wasteful(intersection: RoadMap) -> None:
    i, j = intersection.paths["south-north"], intersection.paths["west-east"]
    (zone,) = intersection.zones("south-north", "west-east", TRUE)
    assert zone.front(113.0) == pytest.approx(112.5, abs=0.15)
    assert zone.back(113.0) == pytest.approx(105.5, abs=0.15)
    assert _depth(i, j, np.array([112.3]), np.array([113.0]), TRUE)[0, 0] > 0
    (merging,) = intersection.zones("south-north", "west-north", TRUE)
    s_j = merging.merge_j + 30.0 if merging.merge_j is not None else math.nan
    same_place = s_j - intersection.paths["west-north"].length + i.length
    assert merging.front(s_j) == pytest.approx(same_place + 5, abs=0.7)
    assert merging.front(s_j) >= same_place + 5


def test_outside_the_zone_nothing_is_blocked(intersection: RoadMap) -> None:
    (zone,) = intersection.zones("south-north", "west-east")
    outside = np.array([0.0, zone.entry_j - 1.0, zone.exit_j + 1.0, 1e4])
    assert (zone.front(outside) == -np.inf).all()
    assert (zone.back(outside) == np.inf).all()
    inside = np.linspace(zone.entry_j, zone.exit_j, 50)
    assert np.isfinite(zone.front(inside)).all()
    assert (zone.front(inside) >= zone.back(inside)).all()


def test_the_mirror_image_swaps_the_two_sides(intersection: RoadMap) -> None:
    for name in ("west-east", "east-west", "west-north", "south-east"):
        for zone in intersection.zones("south-north", name):
            mirror = zone.mirrored()
            assert (mirror.entry_i, mirror.exit_i, mirror.point_i) == (zone.entry_j, zone.exit_j, zone.point_j)
            assert (mirror.merge_i, mirror.merge_j) == (zone.merge_j, zone.merge_i)
            assert (mirror.split_i, mirror.split_j) == (zone.split_j, zone.split_i)
            s = np.linspace(zone.entry_j - 1, zone.exit_j + 1, 60)
            np.testing.assert_array_equal(mirror.mirrored().front(s), zone.front(s))
            (other_way,) = find_zones(intersection.paths[name], intersection.paths["south-north"], PLANNING)
            assert other_way.entry_i == pytest.approx(zone.entry_j, abs=1e-6)
            assert other_way.exit_j == pytest.approx(zone.exit_i, abs=1e-6)
            assert other_way.relation is zone.relation
            np.testing.assert_allclose(
                other_way.back(s - zone.entry_j + zone.entry_i), mirror.back(s - zone.entry_j + zone.entry_i), atol=1e-6
            )


def test_merge_and_split_lie_where_the_centre_lines_part(intersection: RoadMap) -> None:
    (zone,) = intersection.zones("south-north", "west-north")
    # The left turn from the west ends at 100 + 13 pi / 2 m and comes within 0.3 m of the lane 2.8 m before that.
    assert zone.relation is Relation.CONVERGING
    assert zone.merge_j == pytest.approx(100 + 13 * math.pi / 2 - 2.8, abs=0.6)
    assert zone.merge_i == pytest.approx(122 - 2.8, abs=0.6)
    assert zone.split_i is None
    (zone,) = intersection.zones("south-north", "south-east")
    assert zone.relation is Relation.DIVERGING
    assert zone.merge_i is None
    assert (zone.split_i, zone.split_j) == pytest.approx((102.3, 102.3), abs=0.6)


def test_vehicles_on_one_route_keep_a_body_length() -> None:
    zone = following_zone(_straight(0, 0, 0), PLANNING)
    assert zone.relation is Relation.FOLLOWING
    assert zone.front(np.array([10.0, 20.0])).tolist() == [16.0, 26.0]
    assert zone.back(10.0) == 4.0
    assert zone.mirrored().front(10.0) == 16.0


BULGE = 0.1
numbers = st.floats(-50.0, 50.0)


@st.composite
def bands(draw: st.DrawFn) -> Band:
    """Bands of a few rows, limits in any order."""
    n = draw(st.integers(1, 9))
    low, high = (draw(arrays(np.float64, n, elements=numbers)) for _ in range(2))
    return Band(draw(numbers), draw(st.sampled_from([0.5, 0.4973, 0.51])), low, high)


def by_rows(band: Band, s: float) -> tuple[float, float]:
    """The worse of the row before and the row after, as the class promises it."""
    low = np.concatenate(([np.inf], band.low, [np.inf]))
    high = np.concatenate(([-np.inf], band.high, [-np.inf]))
    row = min(max((s - band.start) / band.spacing, -1.0), float(len(band.low)))
    k = [int(np.floor(row)) + 1, int(np.ceil(row)) + 1]
    return float(low[k].min() - BULGE), float(high[k].max() + BULGE)


@given(bands(), st.lists(st.floats(-3.0, 13.0), min_size=1, max_size=6))
def test_a_look_up_is_the_worse_of_both_rows(band: Band, rows: list[float]) -> None:
    places = [band.start + band.spacing * row for row in (*rows, *range(-2, len(band.low) + 2))]
    places += [float("inf"), float("-inf")]
    expected = [by_rows(band, s) for s in places]
    assert list(zip(band.lowest(places).tolist(), band.highest(places).tolist(), strict=True)) == expected


@given(bands() | st.builds(FollowingBand, st.floats(1.0, 9.0)), arrays(np.float64, (2, 3), elements=numbers))
def test_both_limits_in_one_go_are_those_one_by_one(band: Band | FollowingBand, places: np.ndarray) -> None:
    low, high = band.blocked(places)
    assert low.tobytes() == band.lowest(places).tobytes()
    assert high.tobytes() == band.highest(places).tobytes()
    assert low.shape == high.shape == places.shape


@given(bands() | st.builds(FollowingBand, st.floats(1.0, 9.0)), arrays(np.float64, 6, elements=numbers), numbers)
def test_no_place_that_is_no_farther_blocks_more(band: Band | FollowingBand, places: np.ndarray, end: float) -> None:
    before = places[places <= end]
    assert (band.highest(before) <= band.most(np.array([end]))).all()
