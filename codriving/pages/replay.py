"""A stored episode as numbers and words that a browser replays: tracks, conflicts, and what each CAV decided."""

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codriving.animation import Talk, deliberated, ground_shapes, maps_in, number_in, sentence, text_in
from codriving.datatypes import Ending, EpisodeRecord, Kind, Severity, Trajectory
from codriving.geometry import RoadMap
from codriving.pages.sections import sections

Line = Mapping[str, Any]

CM = 100.0  # Places are written in centimetres, speeds in cm/s
MRAD = 1000.0  # Headings in thousandths of a radian

# From the worst to what is not drawn.
BANDS = (Severity.SERIOUS, Severity.GENERAL, Severity.SLIGHT)


def road_data(road_map: RoadMap) -> dict[str, Any]:
    """What of a road does not move, as polygons and lines in centimetres: x, y, x, y, ..."""
    shapes = ground_shapes(road_map)
    names = ("asphalt", "full", "striped", "goals", "blocks", "buildings")
    routes = {
        name: _flat(np.column_stack(path.position(np.arange(0.0, road_map.routes[name].goal + 2.0, 2.0))))
        for name, path in road_map.paths.items()
        if name in road_map.routes
    }
    return {**{name: [_flat(line) for line in getattr(shapes, name)] for name in names}, "routes": routes}


def replay_data(
    record: EpisodeRecord,
    trajectory: Trajectory,
    decisions: Sequence[Line],
    transcript: Sequence[Line],
    road_map: RoadMap,
) -> dict[str, Any]:
    """Give an episode to the page."""
    cavs = sum(track.kind is Kind.CAV for track in trajectory.tracks)
    asked: dict[float, list[Line]] = {}
    for line in transcript:
        asked.setdefault(round(number_in(line, "time") or 0.0, 3), []).append(line)
    talk = Talk()
    collision = record.outcome.collision
    return {
        "step": trajectory.step,
        "vehicles": [
            {
                "id": track.id,
                "kind": track.kind.value,
                "size": [track.length, track.width],
                "style": track.style,
                "route": track.route,
                "first": track.first_step,
                "x": _steps(track.x, CM),
                "y": _steps(track.y, CM),
                "h": _steps(np.unwrap(track.heading), MRAD),
                "v": _steps(track.speed, CM),
                "arrived": record.outcome.arrivals.get(track.id),
            }
            for track in trajectory.tracks
        ],
        "steps": [_step(line, asked, talk, road_map) for line in decisions],
        "ending": {
            "text": sentence(record.outcome, cavs),
            "good": record.outcome.ending in (Ending.SUCCESS, Ending.COUNTED),
            "hit": [collision.striker, collision.struck] if collision else [],
        },
    }


def _step(line: Line, asked: Mapping[float, Sequence[Line]], talk: Talk, road_map: RoadMap) -> dict[str, Any]:
    content = deliberated(line, road_map)
    questions = asked.get(round(content.time, 3), ())
    said = maps_in(line, "said")
    marks = []
    for meeting in content.meetings:
        if meeting.severity in BANDS:
            place = None
            if meeting.ways is not None:
                route, at = meeting.ways[0]
                place = [round(CM * float(v)) for v in road_map.paths[route].position(at)]
            band = BANDS.index(meeting.severity)
            marks.append([meeting.one, meeting.other, band, round(meeting.dttcp, 1), int(meeting.certain), place])
    cavs = {
        text_in(entry, "id"): {
            "a": text_in(entry, "action"),
            "r": text_in(entry, "reason"),
            "w": list(thought.waits_for),
            "x": len(entry["removed"]) if isinstance(entry.get("removed"), Mapping) else 0,
            "route": content.routes.get(text_in(entry, "id"), ""),
            "s": sections(entry, said, questions_of(text_in(entry, "id"), content.thoughts, questions)),
        }
        for entry in maps_in(line, "cavs")
        if (thought := content.thoughts.get(text_in(entry, "id"))) is not None
    }
    return {
        "t": content.time,
        "title": content.order_title,
        "order": list(content.order or ()),
        "talk": list(talk.after(line)),
        "marks": marks,
        "cavs": cavs,
    }


def questions_of(name: str, cavs: Collection[str], asked: Iterable[Line]) -> list[Line]:
    """Choose what was asked for a CAV: what names it, and what names none."""
    named = [(line, set(re.findall(r"[\w-]+", text_in(line, "subject")))) for line in asked]
    return [line for line, words in named if name in words or not words & set(cavs)]


def _steps(values: NDArray[np.float64], scale: float) -> list[int]:
    """Whole numbers, each but the first as its distance from the one before: these compress well."""
    whole = np.rint(values * scale).astype(int)
    return [int(n) for n in np.diff(whole, prepend=0)]


def _flat(points: NDArray[np.float64]) -> list[int]:
    return [int(n) for n in np.rint(np.asarray(points) * CM).astype(int).ravel()]
