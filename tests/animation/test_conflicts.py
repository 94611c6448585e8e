"""Open conflicts: marked where the two would meet, the more striking the more severe."""

from typing import Any

import numpy as np
import pytest
from crossing import Frame, crossing, is_colour, share

from codriving.animation.canvas import Canvas
from codriving.animation.conflicts import ConflictLayer, conflict_lines, pressing, worst_first
from codriving.animation.content import DrawnConflict, DrawnVehicle
from codriving.animation.style import PAPER, SEVERITIES
from codriving.animation.window import Area, FreeSpace, Window
from codriving.datatypes.order import Severity
from codriving.datatypes.world import Kind

WINDOW = Window(Area(0.0, 0.0, 400.0, 400.0), 0.0, 0.0, 10.0)
WAYS = (("east", 30.0), ("south", 30.0))


def meeting(one: str = "CAV1", other: str = "HDV1", dttcp: float = 1.0, **changes: Any) -> DrawnConflict:
    values: dict[str, Any] = {"severity": Severity.SERIOUS, "certain": True, "ways": WAYS, **changes}
    return DrawnConflict(one, other, dttcp=dttcp, **values)


def cars(cav: float = -15.0, hdv: float = -15.0) -> list[DrawnVehicle]:
    """CAV1 on the way east, HDV1 on the way south; places along them from the crossing [m]."""
    return [
        DrawnVehicle("CAV1", Kind.CAV, cav, 0.0, 0.0, 5.0, "east"),
        DrawnVehicle("HDV1", Kind.HDV, 0.0, hdv, np.pi / 2, 5.0),
    ]


def drawn(*meetings: DrawnConflict, bodies: list[DrawnVehicle] | None = None, words: bool = False) -> Frame:
    canvas = Canvas(400, 400)
    canvas.fill("#cfd3d9")
    shown = ConflictLayer(meetings, bodies or cars(), crossing())
    shown.lines(canvas, WINDOW)
    shown.marks(canvas, WINDOW)
    if words:
        shown.label(canvas, WINDOW, FreeSpace(WINDOW.area))
    return canvas.pixels


def test_the_mark_stands_where_the_ways_cross() -> None:
    frame = drawn(meeting())
    assert is_colour(frame, 200 - 6, 200, SEVERITIES[Severity.SERIOUS].colour)


@pytest.mark.parametrize("severity", SEVERITIES)
def test_every_band_of_danger_has_its_own_look(severity: Severity) -> None:
    looks = {band: drawn(meeting(severity=band)) for band in SEVERITIES}
    marked = {band: share(frame, SEVERITIES[band].colour) for band, frame in looks.items()}
    assert marked[severity] > 0
    covered = [float((frame[..., :3] != (0xCF, 0xD3, 0xD9)).any(-1).mean()) for frame in looks.values()]
    assert covered == sorted(covered, reverse=True)


def test_no_danger_is_not_drawn() -> None:
    assert (drawn(meeting(severity=Severity.NONE)) == drawn()).all()


def test_a_guess_is_hollow() -> None:
    frame = drawn(meeting(certain=False))
    assert is_colour(frame, 200 - 5, 200, PAPER)


def test_the_ways_of_both_are_drawn_up_to_the_mark() -> None:
    frame = drawn(meeting())
    assert not is_colour(frame, 200 - 60, 200, "#cfd3d9")
    assert not is_colour(frame, 200, 200 - 60, "#cfd3d9")
    assert is_colour(frame, 200 + 60, 200, "#cfd3d9")
    assert is_colour(frame, 200 - 170, 200, "#cfd3d9")


def test_the_way_of_one_who_is_past_the_mark_is_not_drawn_any_more() -> None:
    frame = drawn(meeting(), bodies=cars(cav=8.0))
    assert is_colour(frame, 200 + 60, 200, "#cfd3d9")
    assert not is_colour(frame, 200, 200 - 60, "#cfd3d9")


def test_one_behind_the_other_meet_between_them() -> None:
    behind = [
        DrawnVehicle("CAV1", Kind.CAV, -15.0, 0.0, 0.0, 5.0, "east"),
        DrawnVehicle("HDV1", Kind.HDV, -5.0, 0.0, 0.0, 5.0),
    ]
    ways = (("east", 20.0), ("east", 20.0))
    for together in (meeting(ways=None), meeting(ways=ways)):
        place, lines = conflict_lines(together, {body.id: body for body in behind}, crossing())
        assert place == pytest.approx((-10.0, 0.0))
        assert lines


def test_a_vehicle_that_has_left_the_road_is_in_no_conflict() -> None:
    assert (drawn(meeting(other="HDV9")) == drawn()).all()


def test_each_cav_gets_one_that_presses_and_the_worst_comes_first() -> None:
    names = {name: DrawnVehicle(name, Kind[name[:3]], 0, 0, 0, 0) for name in ("CAV1", "CAV2", "CAV3", "HDV1")}
    given = [
        meeting("CAV1", "HDV1", 4.0, severity=Severity.GENERAL),
        meeting("CAV1", "CAV2", 1.0),
        meeting("CAV2", "HDV1", 1.5),
        meeting("CAV3", "HDV1", 7.0, severity=Severity.SLIGHT),
        meeting("CAV3", "CAV1", 9.0, severity=Severity.NONE),
    ]
    ranked = worst_first(given)
    assert [m.dttcp for m in ranked] == [1.0, 1.5, 4.0, 7.0]
    assert [m.dttcp for m in pressing(ranked, names)] == [1.0, 7.0]


def test_words_say_how_severe_it_is() -> None:
    colour = SEVERITIES[Severity.SERIOUS].colour
    assert share(drawn(meeting(), words=True), colour) > share(drawn(meeting()), colour)
