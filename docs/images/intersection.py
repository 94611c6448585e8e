"""Draws one moment of a real episode as an SVG: roads, vehicles, routes, conflict zones, order and decisions.

Run it from the top level of the repository, in an environment that has codriving:

    python docs/images/intersection.py

It writes ``docs/images/intersection.svg``. Seed and moment are the two constants below.
"""

from collections.abc import Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from codriving.config.compose import compose
from codriving.datatypes.order import Conflict, Severity
from codriving.datatypes.road import Lane, Line
from codriving.datatypes.situation import ReasonedDeliberation, Situation
from codriving.datatypes.world import Kind, VehicleState, WorldState
from codriving.experiment.objects import BuildObjects
from codriving.geometry.box import PLANNING, corners
from codriving.geometry.lane_path import lane_path
from codriving.geometry.path import Path as Way
from codriving.geometry.road_map import RoadMap

SEED, MOMENT = 10003, 5.5
"""The episode, and the time of the decision that is drawn [s]."""

SIZE, SCALE = 960, 11.2
"""Side of the picture [px], and pixels a metre."""

LEFT, RIGHT = 28, SIZE // 2 + 80
"""Where words begin in the corners that the road leaves free [px]."""

BEYOND, LONGEST = 18.0, 70.0
"""What is left out at the end of a human driver's possible routes, and what is shown of a CAV's at most [m]."""

EDGE = 72.0
"""Half the width of a name, which must not leave the picture [px]."""

JUNCTION = 11.0
"""Half the side of the junction [m]."""

BOLD = 'font-weight="700"'
DOTS = 'stroke-dasharray="0.1 9" stroke-linecap="round"'

PAPER, ASPHALT, PAINT, INK, FAINT = "#fbfbf8", "#dfe1e4", "#ffffff", "#20242a", "#6a727d"
COLOURS = {Kind.CAV: "#0072b2", Kind.HDV: "#e69f00"}
"""Blue and orange of Okabe and Ito (2008), told apart by colour-blind people, and by their lightness in print."""

DANGER = {
    Severity.SERIOUS: "#7a1f5c",
    Severity.GENERAL: "#b8559a",
    Severity.SLIGHT: "#d99cc6",
    Severity.NONE: "#eacfe2",
}
"""One hue, darker with danger."""

Points = NDArray[np.float64]


def look() -> tuple[RoadMap, WorldState, ReasonedDeliberation]:
    """Drive the episode up to the moment, and return what there was and what was decided."""
    objects = BuildObjects({"picture": compose([])})("picture")
    environment, method = objects.environment, objects.method
    world = environment.reset(SEED)
    method.reset(environment.road_map, environment.driving_model, SEED)
    while True:
        decided = method.act(world)
        if world.time >= MOMENT:
            assert isinstance(decided, ReasonedDeliberation)
            return environment.road_map, world, decided
        world = environment.step(decided.actions)


def pixels(points: Points) -> str:
    """Write points (n, 2) [m] as the coordinates of a polyline [px]."""
    return " ".join(f"{SIZE / 2 + SCALE * x:.1f},{SIZE / 2 + SCALE * y:.1f}" for x, y in points.tolist())


def stretch(way: Way, start: float, end: float, side: float = 0.0) -> Points:
    """Return the part of a way between two arc lengths, moved to the right by `side` [m]."""
    s = np.append(np.arange(start, end, 1.0), end)
    x, y = way.position(s)
    heading = way.heading(s)
    return np.column_stack((x - side * np.sin(heading), y + side * np.cos(heading)))


def band(way: Way, start: float, end: float) -> Points:
    """Return the outline of the ground that is covered on a part of a way."""
    half = PLANNING.width / 2
    return np.concatenate((stretch(way, start, end, -half), stretch(way, start, end, half)[::-1]))


def line(points: Points, colour: str, width: float, more: str = "") -> str:
    """Draw a line; `width` in px."""
    return f'<polyline points="{pixels(points)}" fill="none" stroke="{colour}" stroke-width="{width:g}" {more}/>'


def text(x: float, y: float, words: str, size: float = 20, colour: str = INK, more: str = "") -> str:
    """Write words at a place [px]."""
    words = words.replace("&", "&amp;").replace("<", "&lt;")
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size:g}" fill="{colour}" {more}>{words}</text>'


def lanes(lanes: Iterable[Lane]) -> Iterable[str]:
    """Draw asphalt first, then the painted lines."""
    ways = [(lane, lane_path(lane)) for lane in lanes]
    for lane, way in ways:
        yield line(way.points, ASPHALT, SCALE * lane.width + 1)
    for lane, way in ways:
        for side, paint in zip((-1, 1), lane.lines, strict=True):
            if paint is not Line.NONE:
                dashes = 'stroke-dasharray="18 18"' if paint is Line.STRIPED else ""
                yield line(stretch(way, 0.0, way.length, side * lane.width / 2), PAINT, 3, dashes)


def most_urgent(situations: Iterable[Situation]) -> list[Conflict]:
    """Return the most urgent conflict of each pair of vehicles, the least urgent pair first."""
    found: dict[frozenset[str], Conflict] = {}
    for conflict in (c for s in situations for c in s.conflicts):
        pair = frozenset((conflict.ego, conflict.other))
        if pair not in found or conflict.dttcp < found[pair].dttcp:
            found[pair] = conflict
    return sorted(found.values(), key=lambda c: -c.dttcp)


def zone(road_map: RoadMap, conflict: Conflict, number: int) -> str:
    """Draw the ground on which the two ways of a conflict overlap; of a merge, up to where the ways have become one."""
    z = road_map.zones(*conflict.routes)[conflict.zone]
    one, other = (road_map.paths[route] for route in conflict.routes)
    exits = z.exit_i if z.merge_i is None else z.merge_i, z.exit_j if z.merge_j is None else z.merge_j
    return (
        f'<clipPath id="way{number}"><polygon points="{pixels(band(other, z.entry_j, exits[1]))}"/></clipPath>'
        f'<polygon points="{pixels(band(one, z.entry_i, exits[0]))}" clip-path="url(#way{number})" '
        f'fill="{DANGER[conflict.severity]}" fill-opacity="0.75"/>'
    )


def routes(road_map: RoadMap, situations: tuple[Situation, ...]) -> Iterable[str]:
    """Draw what is known of each vehicle's way: the route that a CAV shares, each that a human driver may take."""
    for human in {n.id: n for s in situations for n in s.scene.neighbours if n.intent is None}.values():
        for route, place in human.routes:
            end = road_map.routes[route].goal - BEYOND
            yield line(stretch(road_map.paths[route], place, end), COLOURS[Kind.HDV], 4.5, DOTS)
    for situation in situations:
        route, place = situation.scene.intent.route, situation.scene.place
        way = stretch(road_map.paths[route], place, min(road_map.routes[route].goal, place + LONGEST))
        yield line(way, COLOURS[Kind.CAV], 3.5, 'marker-end="url(#arrow)"')


def vehicle(state: VehicleState) -> str:
    """Draw a vehicle with its front."""
    body = corners(state.x, state.y, state.heading, state.length, state.width)
    nose = state.x + 1.1 * np.cos(state.heading), state.y + 1.1 * np.sin(state.heading)
    glass = corners(*nose, state.heading, 1.0, state.width - 0.4)
    return (
        f'<polygon points="{pixels(body)}" fill="{COLOURS[state.kind]}" stroke="{INK}" stroke-width="1.5" '
        f'stroke-linejoin="round"/><polygon points="{pixels(glass)}" fill="{PAPER}" fill-opacity="0.85"/>'
    )


def name(state: VehicleState) -> str:
    """Write who a vehicle is and how fast, on the side that the road leaves free."""
    x, y = SIZE / 2 + SCALE * state.x, SIZE / 2 + SCALE * state.y
    along_y = abs(np.sin(state.heading)) > abs(np.cos(state.heading))
    right, below = state.x > 0, state.y > 0
    place = (
        (x + (26 if right else -26), y + 6) if along_y else (min(max(x, EDGE), SIZE - EDGE), y + (41 if below else -28))
    )
    aside = along_y or abs(state.x) < JUNCTION
    anchor = ("start" if right else "end") if aside else "middle"
    words = f"{state.id}  {state.speed:.1f} m/s"
    # The halo on its own, since not every viewer paints a stroke behind its text.
    halo = f'text-anchor="{anchor}" stroke="{PAPER}" stroke-width="5" stroke-linejoin="round" stroke-opacity="0.85"'
    return text(*place, words, 18, PAPER, halo) + text(*place, words, 18, INK, f'text-anchor="{anchor}"')


def legend() -> Iterable[str]:
    """Explain the colours."""
    x, y = LEFT, 120.0
    yield text(x, y, f"Intersection, seed {SEED}, {MOMENT:g} s", 22, INK, BOLD)
    for kind, words, dots in (
        (Kind.CAV, "CAV and the route that it shares", ""),
        (Kind.HDV, "human driver, possible routes", DOTS),
    ):
        y += 34
        yield f'<rect x="{x}" y="{y - 15}" width="36" height="18" fill="{COLOURS[kind]}" stroke="{INK}"/>'
        yield f'<path d="M{x + 44},{y - 6} h40" stroke="{COLOURS[kind]}" stroke-width="4" {dots}/>'
        yield text(x + 96, y, words, 18)


def severities() -> Iterable[str]:
    """Explain the shades of the conflict zones."""
    x, y = RIGHT, SIZE / 2 + 220.0
    yield text(x, y, "Conflict zones by severity", 20, INK, BOLD)
    for severity, limit in zip(DANGER, ("dTTCP up to 2 s", "up to 5 s", "up to 8 s", "beyond 8 s"), strict=True):
        y += 30
        yield f'<rect x="{x}" y="{y - 15}" width="36" height="19" fill="{DANGER[severity]}"/>'
        yield text(x + 48, y, f"{severity}, {limit}", 18)


def order(decided: ReasonedDeliberation) -> Iterable[str]:
    """Write who goes first."""
    x, y = LEFT, SIZE / 2 + 220.0
    agreed = decided.situations[0].order
    yield text(x, y, "The negotiated passing order", 20, INK, BOLD)
    for k, vehicle_id in enumerate(agreed.sequence):
        y += 44 if k % 4 == 0 else 0
        left, colour = x + 92 * (k % 4), COLOURS[Kind.CAV if vehicle_id.startswith("CAV") else Kind.HDV]
        yield (
            f'<rect x="{left}" y="{y - 22}" width="84" height="31" rx="7" fill="none" stroke="{colour}" '
            f'stroke-width="3"/>'
        )
        yield text(left + 42, y, f"{k + 1}  {vehicle_id}", 17, INK, 'text-anchor="middle"')


def reasons(decided: ReasonedDeliberation) -> Iterable[str]:
    """Write what every CAV decides, and why."""
    x, y = RIGHT, 60.0
    yield text(x, y, "What each CAV decides", 20, INK, BOLD)
    for decision in decided.decisions:
        y += 36
        yield text(x, y, f"{decision.ego}  {decision.action}", 18, COLOURS[Kind.CAV], BOLD)
        for words in wrapped(decision.reason, 44):
            y += 22
            yield text(x, y, words, 17, FAINT)


def wrapped(words: str, width: int) -> list[str]:
    """Break words into lines of at most `width` characters."""
    lines = [""]
    for word in words.split():
        if len(lines[-1]) + len(word) >= width:
            lines.append("")
        lines[-1] = f"{lines[-1]} {word}".strip()
    return lines


def draw() -> str:
    """Return the whole picture."""
    road_map, world, decided = look()
    conflicts = most_urgent(decided.situations)
    arrow = f'<path d="M0,0 L7,3.5 L0,7 z" fill="{COLOURS[Kind.CAV]}"/>'
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {SIZE} {SIZE}" '
        'font-family="Helvetica, Arial, sans-serif">',
        "<title>The intersection at one moment of an episode</title>",
        f'<defs><marker id="arrow" markerWidth="7" markerHeight="7" refX="5" refY="3.5" orient="auto">{arrow}</marker>'
        "</defs>",
        f'<rect width="{SIZE}" height="{SIZE}" fill="{PAPER}"/>',
        *lanes(road_map.road.lanes),
        *(zone(road_map, conflict, k) for k, conflict in enumerate(conflicts)),
        *routes(road_map, decided.situations),
        *(vehicle(v) for v in world.vehicles),
        *(name(v) for v in world.vehicles),
        *legend(),
        *severities(),
        *order(decided),
        *reasons(decided),
        "</svg>",
    ]
    return "\n".join(parts) + "\n"


if __name__ == "__main__":
    Path(__file__).with_suffix(".svg").write_text(draw(), encoding="utf-8")
