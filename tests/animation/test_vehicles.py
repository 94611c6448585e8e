"""Who is a CAV and who is not, told by colour and by shape; where it heads, and what it is called."""

import math

import numpy as np
import pytest
from crossing import Frame, is_colour, share

from codriving.animation.canvas import Canvas
from codriving.animation.content import DrawnDecision, DrawnVehicle, FrameContent
from codriving.animation.style import ACTIONS, BLUE, INK, ORANGE, PAPER
from codriving.animation.vehicles import draw_names, draw_vehicles
from codriving.animation.window import Area, FreeSpace, Window
from codriving.datatypes.world import Action, Kind

VIEW = Area(0.0, 0.0, 300.0, 300.0)
WINDOW = Window(VIEW, 0.0, 0.0, 20.0)


def body(kind: Kind, heading: float = 0.0, x: float = 0.0, name: str = "") -> DrawnVehicle:
    return DrawnVehicle(name or f"{kind}1", kind, x, 0.0, heading, 7.5)


def bodies(*given: DrawnVehicle, window: Window = WINDOW) -> Frame:
    canvas = Canvas(300, 300)
    canvas.fill("#cfd3d9")
    draw_vehicles(canvas, window, given)
    return canvas.pixels


def test_a_cav_is_filled_with_blue() -> None:
    frame = bodies(body(Kind.CAV))
    assert is_colour(frame, 150 - 30, 150, BLUE)
    assert share(frame, ORANGE) == 0


def test_a_human_driver_is_hollow_with_an_orange_rim() -> None:
    frame = bodies(body(Kind.HDV))
    assert is_colour(frame, 150 - 20, 150, PAPER)
    assert share(frame, ORANGE) > 0.002
    assert share(frame, BLUE) == 0


def test_the_kinds_differ_without_any_colour() -> None:
    """In grey, and by outline alone: a CAV is pointed, a human driver square."""
    grey = [frame[..., :3].astype(float) @ (0.299, 0.587, 0.114) for frame in map(bodies, map(body, Kind))]
    assert abs(grey[0][150, 120] - grey[1][150, 120]) > 100
    front = 150 + 45
    heights = [(np.abs(picture[:, front] - picture[0, 0]) > 20).sum() for picture in grey]
    assert heights[0] < heights[1] / 2 + 5


@pytest.mark.parametrize("heading", [0.0, math.pi / 2, math.pi, -math.pi / 2])
def test_the_nose_points_where_it_heads(heading: float) -> None:
    frame = bodies(body(Kind.CAV, heading))
    x, y = 150 + 46 * math.cos(heading), 150 + 46 * math.sin(heading)
    assert not is_colour(frame, x, y, "#cfd3d9")
    side_x, side_y = x - 16 * math.sin(heading), y + 16 * math.cos(heading)
    assert is_colour(frame, side_x, side_y, "#cfd3d9")


def test_far_away_a_vehicle_is_still_a_symbol() -> None:
    frame = bodies(body(Kind.CAV), window=Window(VIEW, 0.0, 0.0, 0.3))
    assert share(frame, BLUE) * 300 * 300 > 25


def named(window: Window, *given: DrawnVehicle) -> Frame:
    canvas = Canvas(300, 300)
    canvas.fill("#cfd3d9")
    draw_names(canvas, window, FreeSpace(window.area), FrameContent(0.0, given, {"CAV1": DrawnDecision(Action.FASTER)}))
    return canvas.pixels


def test_the_name_stands_over_the_vehicle_with_its_action() -> None:
    frame = named(WINDOW, body(Kind.CAV))
    above = frame[100:132, 90:210]
    assert share(above, INK, 60) > 0.02
    assert share(above, ACTIONS[Action.FASTER], 20) > 0.003
    assert share(frame[190:], INK, 60) == 0


def test_a_human_driver_shows_no_action() -> None:
    frame = named(WINDOW, body(Kind.HDV))
    assert share(frame, INK, 60) > 0
    assert share(frame, ACTIONS[Action.FASTER], 20) == 0


def test_a_vehicle_is_named_in_one_row_only() -> None:
    left = Window(Area(0.0, 0.0, 300.0, 140.0), 0.0, 0.0, 10.0, dim=(0.0, 100.0))
    assert share(named(left, body(Kind.CAV, x=10.0)), INK, 60) == 0
    assert share(named(left, body(Kind.CAV, x=-5.0)), INK, 60) > 0
