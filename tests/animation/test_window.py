"""Windows onto the world, and room for words on them."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from codriving.animation.window import LARGEST, Area, FreeSpace, Window, beside, overlap, rows

FRAME = Area(0.0, 0.0, 896.0, 720.0)
lengths = st.floats(20.0, 3000.0)


@given(lengths, lengths, st.floats(-500, 500), st.floats(-500, 500))
def test_every_place_belongs_to_exactly_one_window(width: float, height: float, left: float, top: float) -> None:
    box = Area(left, top, width, height)
    windows = rows(box, FRAME)
    rng = np.random.default_rng(0)
    for point in rng.uniform((left, top), (left + width, top + height), size=(20, 2)):
        assert sum(window.owns(point) for window in windows) == 1
    assert all(0 < window.zoom <= LARGEST for window in windows)


@given(lengths, lengths)
def test_windows_share_no_pixel_and_stay_in_the_frame(width: float, height: float) -> None:
    areas = [window.area for window in rows(Area(0.0, 0.0, width, height), FRAME)]
    assert all(a.top >= -1e-6 and a.top + a.height <= FRAME.height + 1e-6 for a in areas)
    assert all(a.top + a.height <= b.top + 1e-6 for a, b in pairwise(areas))


def test_a_compact_road_has_one_view() -> None:
    (window,) = rows(Area(-80.0, -80.0, 160.0, 160.0), FRAME)
    assert window.area == FRAME
    assert window.zoom == pytest.approx(720 / 160)


def test_a_long_road_has_rows_and_is_shown_larger_for_it() -> None:
    windows = rows(Area(0.0, -10.0, 750.0, 28.0), FRAME)
    assert len(windows) >= 4
    assert windows[0].zoom > 3 * 896 / 750


def test_a_road_that_runs_down_the_map_is_turned() -> None:
    windows = rows(Area(-10.0, 0.0, 28.0, 750.0), FRAME)
    assert len(windows) >= 4
    window = windows[0]
    assert window.turned
    (x1, y1), (x2, y2) = window.place([(0.0, 100.0), (0.0, 110.0)])
    assert (x2 - x1, y2 - y1) == pytest.approx((10 * window.zoom, 0.0))
    # Still seen from above: what is to the right of the way of travel stays there.
    (_, y3) = window.place((-1.0, 100.0))
    assert y3 > y1


@given(st.booleans(), st.floats(0.5, 12.0), st.floats(-99, 99), st.floats(-99, 99))
def test_the_matrix_says_the_same_as_place(turned: bool, zoom: float, x: float, y: float) -> None:
    window = Window(Area(10.0, 20.0, 300.0, 200.0), 5.0, -7.0, zoom, turned)
    assert (window.matrix @ (x, y, 1.0))[:2] == pytest.approx(window.place((x, y)))


def test_a_line_right_across_is_seen_though_both_ends_are_outside() -> None:
    window = Window(Area(0.0, 0.0, 100.0, 100.0), 0.0, 0.0, 1.0)
    assert window.sees([(-200.0, 0.0), (200.0, 0.0)])
    assert not window.sees([(-200.0, 80.0), (200.0, 80.0)])
    assert window.sees([(-200.0, 80.0), (200.0, 80.0)], margin=40.0)


SHEET = Area(0.0, 0.0, 400.0, 300.0)


@given(st.lists(st.tuples(st.floats(0, 380), st.floats(0, 290)), max_size=12), st.floats(10, 90))
def test_words_stay_in_the_frame(places: list[tuple[float, float]], width: float) -> None:
    space = FreeSpace(SHEET)
    for x, y in places:
        own = Area(x, y, 20.0, 8.0)
        space.take(own)
        spot = space.find(beside(own, width, 15.0))
        assert spot.left >= 0
        assert spot.top >= 0
        assert spot.left + spot.width <= 400
        assert spot.top + spot.height <= 300


def test_three_side_by_side_cover_nothing() -> None:
    space = FreeSpace(SHEET)
    things = [Area(180.0, 100.0 + 20 * k, 30.0, 12.0) for k in range(3)]
    for thing in things:
        space.take(thing)
    spots = [space.find(beside(thing, 60.0, 15.0)) for thing in things]
    everything = [*things, *spots]
    assert all(overlap(a, b) == 0 for k, a in enumerate(everything) for b in everything[k + 1 :])


def test_what_stands_upright_is_named_at_its_side() -> None:
    own = Area(100.0, 100.0, 8.0, 20.0)
    spot = FreeSpace(SHEET).find(beside(own, 60.0, 15.0))
    assert spot.left >= own.left + own.width
