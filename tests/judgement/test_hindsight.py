"""What was judged against what was driven, on tracks made by hand."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from worlds import Junction

from codriving.datatypes.record import Track, Trajectory
from codriving.datatypes.world import Kind
from codriving.judgement.hindsight import entries, let_pass, look_back


def track(junction: Junction, name: str, route: str, start: float, speed: float) -> Track:
    """A vehicle that keeps its speed for 10 s, from a place on its route."""
    s = start + speed * 0.1 * np.arange(101)
    path = junction.road_map.paths[route]
    x, y = path.position(s)
    kind = Kind.CAV if name.startswith("CAV") else Kind.HDV
    moving = np.full(len(s), speed)
    return Track(name, kind, route, 0, x, y, path.heading(s), moving, 0 * moving, ("",) * len(s), None)


def line(time: float, **said: tuple[float, str]) -> dict[str, Any]:
    """A line of decisions in which CAV1 judges drivers."""
    judged = {name: {"yields": p, "answer": answer, "reason": ""} for name, (p, answer) in said.items()}
    return {"time": time, "cavs": [{"id": "CAV1", **({"judgements": judged} if judged else {})}]}


@pytest.mark.parametrize(
    ("start", "said", "expected"),
    [
        # The CAV is there first: the driver has let it pass.
        (60.0, (0.9, "yields"), (1, 1, 1, 0.01, 0, 0, 0.0)),
        (60.0, (0.2, "goes"), (1, 1, 0, 0.64, 0, 1, 0.5)),
        (60.0, (0.5, "unclear"), (1, 0, 0, 0.25, 0, 0, 0.0)),
        # The driver is there first.
        (100.0, (0.9, "yields"), (1, 1, 0, 0.81, 1, 0, 0.0)),
        (100.0, (0.2, "goes"), (1, 1, 1, 0.04, 0, 0, 0.0)),
    ],
)
def test_one_judgement(start: float, said: tuple[float, str], expected: tuple[float, ...], junction: Junction) -> None:
    tracks = track(junction, "CAV1", "south-north", 80.0, 8.0), track(junction, "HDV1", "east-west", start, 8.0)
    found = look_back([line(0.0, HDV1=said), line(0.5)], Trajectory(0.1, tracks), junction.road_map)
    assert tuple(found.values()) == pytest.approx(expected)
    names = ["judged", "judged_decided", "judged_right", "judged_squares", "yields_but_went", "goes_but_yielded"]
    assert list(found) == [*names, "seconds_lost"]


def test_a_cav_is_held_up_once_a_step_by_any_error(junction: Junction) -> None:
    """All drivers came later, as was foretold of the last one alone."""
    tracks = [track(junction, name, "east-west", 60.0, 8.0) for name in ("HDV1", "HDV2", "HDV3")]
    driven = Trajectory(0.1, (track(junction, "CAV1", "south-north", 80.0, 8.0), *tracks))
    said = {"HDV1": (0.2, "goes"), "HDV2": (0.2, "goes"), "HDV3": (0.9, "yields")}
    assert look_back([line(0.0, **said), line(0.5)], driven, junction.road_map)["seconds_lost"] == 0.5


def test_entries_are_when_the_zone_begins_also_on_a_track_that_begins_later(junction: Junction) -> None:
    cav, human = track(junction, "CAV1", "south-north", 80.0, 8.0), track(junction, "HDV1", "east-west", 60.0, 8.0)
    human = replace(human, first_step=50)
    places = {t.id: start + 0.8 * np.arange(101) for t, start in ((cav, 80.0), (human, 60.0))}
    [found] = entries(cav, human, places, junction.road_map, 0.1)
    [zone] = junction.road_map.zones("south-north", "east-west")
    assert found == pytest.approx(((zone.entry_i - 80) / 8 + 0.05, 5 + (zone.entry_j - 60) / 8 + 0.05), abs=0.05)


def test_nothing_is_counted_where_nothing_was_judged(junction: Junction) -> None:
    tracks = (track(junction, "CAV1", "south-north", 80.0, 8.0),)
    assert look_back([line(0.0), line(0.5)], Trajectory(0.1, tracks), junction.road_map) == {}


def test_what_the_driver_did_is_not_known_if_neither_came_or_it_never_was_there(junction: Junction) -> None:
    tracks = track(junction, "CAV1", "south-north", 20.0, 1.0), track(junction, "HDV1", "east-west", 20.0, 1.0)
    lines = [line(0.0, HDV1=(0.9, "yields"), HDV9=(0.9, "yields"))]
    assert look_back(lines, Trajectory(0.1, tracks), junction.road_map)["judged"] == 0


def test_the_next_zone_counts_that_neither_had_entered() -> None:
    entered = [(1.0, 4.0), (6.0, 5.0), (float("inf"), float("inf"))]
    assert let_pass(entered, 0.9) is True
    assert let_pass(entered, 1.0) is False
    assert let_pass(entered, 5.0) is None
