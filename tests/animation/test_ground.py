"""The road as it is: asphalt without holes or seams, painted lines, goals, and what stands on it."""

import numpy as np
from crossing import Frame, crossing, highway, is_colour, share

from codriving.animation.canvas import Canvas
from codriving.animation.ground import Ground
from codriving.animation.style import ASPHALT, BUILDING, GREEN, GROUND, INK, PAINT
from codriving.animation.window import Area, Window
from codriving.datatypes.road import Block
from codriving.geometry.road_map import RoadMap

VIEW = Area(0.0, 0.0, 400.0, 400.0)


def drawn(road_map: RoadMap, window: Window) -> Frame:
    canvas = Canvas(400, 400)
    canvas.fill("#000000")
    Ground(road_map).draw(canvas, (window,))
    return canvas.pixels


def test_lanes_are_asphalt_and_the_rest_is_land() -> None:
    window = Window(VIEW, 0.0, 0.0, 8.0)
    frame = drawn(crossing(), window)
    for x, y, colour in ((-15, 0, ASPHALT), (0.5, -15, ASPHALT), (-15, 8, GROUND), (10, 10, GROUND)):
        assert is_colour(frame, *window.place((x, y)), colour)


def test_lanes_that_overlap_leave_no_hole() -> None:
    window = Window(VIEW, 0.0, 0.0, 40.0)
    frame = drawn(crossing(), window)
    inner = frame[130:270, 130:270]
    assert share(inner, ASPHALT) + share(inner, PAINT) > 0.95
    assert share(inner, ASPHALT) > 0.8


def test_no_seam_of_land_between_lanes_side_by_side() -> None:
    frame = drawn(highway(), Window(VIEW, 100.0, 4.0, 37.3))
    column = frame[60:340, ::7]
    assert share(column, GROUND, 4) == 0


def test_a_full_line_is_painted_on_the_left_and_dashes_on_the_right() -> None:
    window = Window(VIEW, -15.0, 0.0, 12.0)
    frame = drawn(crossing(), window)
    left, right = (round(float(window.place((0.0, side))[1])) for side in (-2.0, 2.0))
    assert share(frame[left, 50:350], PAINT) > 0.95
    assert 0.2 < share(frame[right, 50:350], PAINT) < 0.7


def test_goals_are_drawn_across_the_road() -> None:
    window = Window(VIEW, 0.0, 0.0, 8.0)
    frame = drawn(crossing(), window)
    x, y = (round(float(v)) for v in window.place((20.0, 0.0)))
    assert share(frame[y - 14 : y + 15, x - 1 : x + 2], GREEN) > 0.3
    assert share(frame[:, : x - 40], GREEN) < 0.01


def test_what_stands_on_the_road_is_seen() -> None:
    window = Window(VIEW, 0.0, 0.0, 8.0)
    frame = drawn(crossing((Block((10.0, 0.0), 2.0, 3.0),)), window)
    x, y = (round(float(v)) for v in window.place((10.0, 0.0)))
    assert share(frame[y - 12 : y + 13, x - 8 : x + 9], INK) > 0.3


def test_buildings_are_seen_beside_the_road_and_not_on_it() -> None:
    window = Window(VIEW, 0.0, 0.0, 8.0)
    frame = drawn(crossing(buildings=(Block((15.0, 13.0), 20.0, 16.0),)), window)
    for x, y, colour in ((15, 13, BUILDING), (6, 6, BUILDING), (4, 12, GROUND), (15, 3.5, GROUND), (15, 1, ASPHALT)):
        assert is_colour(frame, *window.place((x, y)), colour)


def test_a_window_is_drawn_in_its_own_part_of_the_frame() -> None:
    canvas = Canvas(400, 400)
    canvas.fill("#ff0000")
    window = Window(Area(100.0, 50.0, 200.0, 100.0), 0.0, 0.0, 8.0)
    Ground(crossing()).draw(canvas, (window,))
    outside = np.ones((400, 400), dtype=bool)
    outside[50:150, 100:300] = False
    assert (canvas.pixels[outside][:, :3] == (255, 0, 0)).all()
    assert share(canvas.pixels[50:150, 100:300], ASPHALT) > 0.2
