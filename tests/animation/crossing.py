"""Two roads that cross at the origin, and an episode on them, all made by hand; and how to look at a frame."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.colors import to_rgba
from numpy.typing import NDArray

from codriving.datatypes.record import Ending, Outcome, Track, Trajectory
from codriving.datatypes.road import Block, Lane, Line, Road, Route, Straight, Turn
from codriving.datatypes.world import Kind
from codriving.geometry.road_map import RoadMap, road_map

LENGTH = 60.0
STEP = 0.1
Frame = NDArray[np.uint8]


def crossing(blocks: tuple[Block, ...] = (), buildings: tuple[Block, ...] = ()) -> RoadMap:
    """One lane to the east and one to the south, each 60 m long with its goal at 50 m; they cross half-way."""
    half = LENGTH / 2
    lines = (Line.CONTINUOUS, Line.STRIPED)
    east = Lane(("w", "e", 0), Straight((-half, 0.0), (half, 0.0)), lines=lines)
    south = Lane(("n", "s", 0), Straight((0.0, -half), (0.0, half)), lines=lines)
    routes = (
        Route("east", (east.id,), Turn.STRAIGHT, 25.0, 50.0),
        Route("south", (south.id,), Turn.STRAIGHT, 25.0, 50.0),
    )
    return road_map(Road("crossing", (east, south), routes, blocks=blocks, buildings=buildings))


def highway(length: float = 800.0, lanes: int = 3) -> RoadMap:
    """A long straight road with several lanes."""
    ids = [("a", "b", k) for k in range(lanes)]
    made = tuple(Lane(i, Straight((0.0, 4.0 * i[2]), (length, 4.0 * i[2]))) for i in ids)
    routes = tuple(Route(f"lane{i[2]}", (i,), Turn.STRAIGHT, 0.0, length - 20.0) for i in ids)
    return road_map(Road("highway", made, routes))


def track(name: str, route: str, place: float, speed: float, steps: int, arrived: float | None = None) -> Track:
    """A vehicle that keeps its speed; places along the route [m]."""
    path = crossing().paths[route]
    s = place + speed * STEP * np.arange(steps)
    x, y = path.position(s)
    kind = Kind.CAV if name.startswith("CAV") else Kind.HDV
    action = tuple("" if k == 0 or kind is Kind.HDV else "FASTER" for k in range(steps))
    return Track(name, kind, route, 0, x, y, path.heading(s), np.full(steps, speed), np.zeros(steps), action, arrived)


def episode() -> tuple[Trajectory, Outcome]:
    """CAV1 to the east arrives after 2 s, CAV2 follows and arrives after 3 s; HDV1 goes south."""
    tracks = (
        track("CAV1", "east", 30.0, 10.0, 21, arrived=2.0),
        track("CAV2", "east", 20.0, 10.0, 31, arrived=3.0),
        track("HDV1", "south", 5.0, 5.0, 31),
    )
    return Trajectory(STEP, tracks), Outcome(Ending.SUCCESS, 3.0, {"CAV1": 2.0, "CAV2": 3.0})


def line(time: float, **changes: Any) -> dict[str, Any]:
    """A line of decisions.jsonl: CAV2 is in conflict with HDV1."""
    conflict = {
        "ego": "CAV2",
        "other": "HDV1",
        "relation": "crossing",
        "routes": ["east", "south"],
        "zone": 0,
        "places": [20.0, 5.0],
        "distances": [6.0, 21.0],
        "exits": [14.0, 29.0],
        "ttcp": [0.6, 4.2],
        "dttcp": 1.2,
        "severity": "serious danger",
        "certain": False,
        **changes,
    }
    order = {
        "sequence": ["HDV1", "CAV1", "CAV2"],
        "binding": False,
        "precedences": [{"first": "HDV1", "second": "CAV2", "reason": "it comes from the left"}],
    }
    scene = {"intent": {"route": "east"}}
    return {
        "time": time,
        "cavs": [
            {"id": "CAV1", "action": "FASTER", "reason": "free", "scene": scene, "conflicts": [], "order": order},
            {
                "id": "CAV2",
                "action": "SLOWER",
                "reason": "lets it pass",
                "scene": scene,
                "conflicts": [conflict],
                "order": order,
            },
        ],
    }


def colour_at(frame: Frame, x: float, y: float) -> tuple[int, ...]:
    """The colour of a pixel, x to the right and y down."""
    return tuple(int(part) for part in frame[round(y), round(x), :3])


def is_colour(frame: Frame, x: float, y: float, name: str, tolerance: int = 6) -> bool:
    """Whether a pixel has a colour, nearly."""
    return bool(np.abs(np.subtract(colour_at(frame, x, y), bytes_of(name))).max() <= tolerance)


def bytes_of(name: str) -> tuple[int, ...]:
    """Red, green and blue of a colour."""
    return tuple(round(part * 255) for part in to_rgba(name)[:3])


def share(frame: Frame, name: str, tolerance: int = 12) -> float:
    """How much of a frame, or of a part of it, has a colour."""
    near = np.abs(frame[..., :3].astype(int) - bytes_of(name)).max(-1) <= tolerance
    return float(near.mean())


def swapped(entry: Mapping[str, Any], **changes: Any) -> dict[str, Any]:
    """A copy with other values."""
    return {**entry, **changes}
