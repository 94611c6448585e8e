"""The collision set against brute force, and its connected parts."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from codriving.datatypes.road import Lane, Straight
from codriving.geometry.box import PLANNING, TRUE, Footprint, corners, overlaps
from codriving.geometry.collision_set import TOUCH, Cells, cell_separation, collision_set, components
from codriving.geometry.lane_path import lane_path
from codriving.geometry.road_map import RoadMap


@pytest.mark.parametrize(("one", "other"), [("south-north", "west-east"), ("south-west", "east-west")])
def test_it_holds_exactly_the_overlapping_pairs(intersection: RoadMap, one: str, other: str) -> None:
    i, j = intersection.paths[one], intersection.paths[other]
    boxes_i, boxes_j = (corners(*p.points.T, p.headings, PLANNING.length, PLANNING.width) for p in (i, j))
    expected = overlaps(boxes_i[:, None], boxes_j[None])
    cells = collision_set(i, j, PLANNING)
    found = np.zeros_like(expected)
    found[cells.i, cells.j] = True
    # Pairs that only touch may fall either way by rounding.
    assert np.count_nonzero(found != expected) <= 2 * len(set(cells.j.tolist()))
    assert found.sum() > 100
    assert (found & ~expected).sum() == 0
    assert sorted(zip(cells.j, cells.i, strict=True)) == list(zip(cells.j, cells.i, strict=True))


@pytest.mark.parametrize("footprint", [PLANNING, TRUE, Footprint(12.0, 2.6)])
@pytest.mark.parametrize("pair", [("s-w", "e-n"), ("s-w", "n-e"), ("s-e", "w-s"), ("e-w", "w-e")])
def test_what_is_decided_without_a_test_is_decided_right(
    roundabout: RoadMap, pair: tuple[str, str], footprint: Footprint
) -> None:
    i, j = (roundabout.paths[name] for name in pair)
    all_j, all_i = np.indices((len(j.points), len(i.points))).reshape(2, -1)
    overlap = cell_separation(i, j, Cells(all_i, all_j), footprint) < -TOUCH
    cells = collision_set(i, j, footprint)
    assert (cells.i.tolist(), cells.j.tolist()) == (all_i[overlap].tolist(), all_j[overlap].tolist())


def test_memory_grows_with_the_length_not_its_square() -> None:
    path = lane_path(Lane(("a", "b", 0), Straight((0, 0), (4000, 0))))
    cells = collision_set(path, path, PLANNING)
    assert len(path.points) == 8001
    assert len(cells.i) < 30 * 8001


def test_routes_that_never_meet_share_nothing(intersection: RoadMap) -> None:
    cells = collision_set(intersection.paths["south-north"], intersection.paths["north-south"], PLANNING)
    assert len(cells.i) == 0
    assert len(components(cells)) == 0


@given(st.sets(st.tuples(st.integers(0, 9), st.integers(0, 9))))
def test_components_are_the_parts_a_king_can_walk(chosen: set[tuple[int, int]]) -> None:
    ordered = sorted(chosen)
    cells = Cells(np.array([i for _, i in ordered], dtype=np.intp), np.array([j for j, _ in ordered], dtype=np.intp))
    number = dict(zip(ordered, components(cells).tolist(), strict=True))
    left, parts = set(chosen), []
    while left:
        part, edge = set(), [left.pop()]
        while edge:
            j, i = edge.pop()
            part.add((j, i))
            near = {(j + dj, i + di) for dj in (-1, 0, 1) for di in (-1, 0, 1)} & left
            left -= near
            edge += near
        parts.append(part)
    assert sorted(set(number.values())) == list(range(len(parts)))
    for part in parts:
        assert len({number[cell] for cell in part}) == 1
