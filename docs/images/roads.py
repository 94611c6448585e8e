"""Draws the road of every scenario as an SVG: lanes, routes, places of arrival, and where vehicles start.

Run it from the top level of the repository, in an environment that has codriving:

    python docs/images/roads.py

It writes ``docs/images/road-<scenario>.svg``, all of it from the road and the scenes that the scenario itself gives.
"""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from codriving.config.build import build
from codriving.config.choices import choices
from codriving.config.compose import compose
from codriving.datatypes.road import Line
from codriving.datatypes.world import Kind
from codriving.geometry.box import corners
from codriving.geometry.lane_path import lane_path
from codriving.geometry.path import Path as Way
from codriving.geometry.road_map import RoadMap, road_map
from codriving.scenarios import Scenario

HERE = Path(__file__).resolve().parent
EXAMPLE = HERE.parents[1] / "examples" / "t_junction" / "conf"

SEEDS = 60
"""Seeds whose starts are shown."""

WIDTH, MARGIN, KEY = 960.0, 14.0, 30.0
"""Width of a picture, the free rim around the road, and the height of the line that explains the signs [px]."""

TALLEST = 560.0
"""Height beyond which a road is drawn smaller [px]."""

ACROSS = 5.0
"""Pixels a metre across a road that runs straight on for hundreds of metres; along it there are fewer."""

ASIDE = 0.9
"""How far CAVs are drawn left and human drivers right of the middle of their lane [m]."""

PAPER, ASPHALT, PAINT, INK, FAINT, GREEN = "#fbfbf8", "#cfd3d9", "#ffffff", "#20242a", "#a2a9b3", "#009e73"
COLOURS = {Kind.CAV: "#0072b2", Kind.HDV: "#e69f00"}

Points = NDArray[np.float64]


@dataclass(frozen=True)
class Sheet:
    """From metres to pixels: `x` and `y` pixels a metre, and where the road begins."""

    left: float
    top: float
    x: float
    y: float
    indent: float

    def pixels(self, points: Points) -> str:
        """Write points (n, 2) [m] as coordinates [px]."""
        return " ".join(f"{a:.1f},{b:.1f}" for a, b in self.place(points).tolist())

    def place(self, points: Points) -> Points:
        """Return points (n, 2) [m] in pixels."""
        placed: Points = (points - (self.left, self.top)) * (self.x, self.y) + (self.indent, MARGIN)
        return placed


def beside(way: Way, s: float | Points, side: float) -> Points:
    """Return points (n, 2) to the right of a way at arc lengths [m]."""
    s = np.atleast_1d(s)
    x, y = way.position(s)
    heading = way.heading(s)
    return np.column_stack((x - side * np.sin(heading), y + side * np.cos(heading)))


def sides(way: Way, side: float) -> Points:
    """Return the line to the right of a whole way; no more points than it takes."""
    straight = float(np.ptp(way.headings)) < 1e-9
    return beside(way, np.linspace(0.0, way.length, 2 if straight else math.ceil(way.length) + 1), side)


def line(sheet: Sheet, points: Points, colour: str, width: float, more: str = "") -> str:
    """Draw a line; `width` in px."""
    drawn = f'<polyline points="{sheet.pixels(points)}" fill="none" stroke="{colour}" stroke-width="{width:g}"'
    return f"{drawn} {more}/>" if more else f"{drawn}/>"


def ground(sheet: Sheet, roads: RoadMap) -> Iterator[str]:
    """Draw asphalt, painted lines, and what stands on the road."""
    ways = [(lane, lane_path(lane)) for lane in roads.road.lanes]
    for lane, way in ways:
        outline = np.concatenate((sides(way, -lane.width / 2), sides(way, lane.width / 2)[::-1]))
        yield f'<polygon points="{sheet.pixels(outline)}" fill="{ASPHALT}" stroke="{ASPHALT}"/>'
    for lane, way in ways:
        for sign, paint in zip((-1, 1), lane.lines, strict=True):
            if paint is not Line.NONE:
                dashes = 'stroke-dasharray="7 8"' if paint is Line.STRIPED else ""
                yield line(sheet, sides(way, sign * lane.width / 2), PAINT, 1.5, dashes)
    for block in roads.road.blocks:
        body = corners(*block.position, block.heading, block.length, block.width)
        yield f'<polygon points="{sheet.pixels(body)}" fill="{INK}" stroke="{INK}" stroke-width="3"/>'


def routes(sheet: Sheet, roads: RoadMap) -> Iterator[str]:
    """Draw where routes lead, where drivers wait who have to give way, and where a vehicle has arrived."""
    seen = set()
    for way in roads.paths.values():
        yield line(sheet, sides(way, 0.0), FAINT, 1.0)
    for route in roads.road.routes:
        way = roads.paths[route.id]
        bars = [(route.goal, route.lanes[-1], GREEN, 'stroke-dasharray="3 2"')]
        if roads.road.regulated:
            bars.append((route.entry, route.lanes[0], INK, ""))
        for s, lane, colour, more in bars:
            half = roads.lanes[lane].width / 2
            bar = np.concatenate((beside(way, s, -half), beside(way, s, half)))
            if (key := (colour, *bar.round().flatten().tolist())) not in seen:
                seen.add(key)
                yield line(sheet, bar, colour, 3.0, more)


def starts(sheet: Sheet, scenario: Scenario, roads: RoadMap) -> Iterator[str]:
    """Draw a dot where a vehicle of some seed starts."""
    dots: dict[Kind, list[str]] = {kind: [] for kind in Kind}
    for start in (start for seed in range(SEEDS) for start in scenario.scene(seed).starts):
        side = -ASIDE if start.kind is Kind.CAV else ASIDE
        (place,) = sheet.place(beside(roads.paths[start.route], start.position, side)).tolist()
        dots[start.kind].append(f"M{place[0]:.1f} {place[1]:.1f}h0")
    for kind, found in dots.items():
        yield f'<path d="{"".join(found)}" stroke="{COLOURS[kind]}" stroke-width="3" stroke-linecap="round"/>'


def text(x: float, y: float, words: str, anchor: str = "start") -> str:
    """Write words [px]."""
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="13" fill="{INK}" text-anchor="{anchor}">{words}</text>'


def names(sheet: Sheet, roads: RoadMap) -> Iterator[str]:
    """Write the name of each leg at its far end."""
    seen = set()
    for route in roads.road.routes:
        leg, _, out = route.id.partition("-")
        if out.isalpha() and leg not in seen:
            seen.add(leg)
            # To the right of the lane; to the left if that is outside of the picture.
            right, left = (sheet.place(beside(roads.paths[route.id], 6.0, side))[0].tolist() for side in (7.0, -11.0))
            place = right if right[1] > MARGIN else left
            heading = float(roads.paths[route.id].heading(0.0))
            upright = abs(math.sin(heading)) > 0.5
            anchor = ("start" if math.sin(heading) < 0 else "end") if upright else "middle"
            yield text(place[0], place[1] + 5, leg, anchor)


def key(roads: RoadMap, top: float, sheet: Sheet) -> Iterator[str]:
    """Explain the signs, and draw rulers."""
    y, x = top + 12, MARGIN
    for kind, words in ((Kind.CAV, "CAVs start"), (Kind.HDV, "human drivers start")):
        dots = f"M{x + 4} {y}h0m9 2h0m8 -3h0"
        yield f'<path d="{dots}" stroke="{COLOURS[kind]}" stroke-width="4" stroke-linecap="round"/>'
        yield text(x + 32, y + 4, words)
        x += 48 + 7.2 * len(words)
    signs = [(GREEN, 'stroke-dasharray="3 2"', "arrived")]
    if roads.road.regulated:
        signs.append((INK, "", "who gives way waits"))
    if roads.road.blocks:
        signs.append((INK, "", "something solid"))
    for colour, more, words in signs:
        wide = 9 if words.startswith("something") else 3
        yield f'<path d="M{x + 4} {y - 8}v16" stroke="{colour}" stroke-width="{wide}" {more}/>'
        yield text(x + 16, y + 4, words)
        x += 34 + 7.2 * len(words)
    ruler = 50 if sheet.x != sheet.y else 20
    end = WIDTH - MARGIN
    yield f'<path d="M{end - ruler * sheet.x:.1f} {y + 5}v-5H{end}v5" fill="none" stroke="{INK}"/>'
    note = f"; drawn {sheet.y / sheet.x:.1f} times too wide" if sheet.x != sheet.y else ""
    yield text(end - ruler * sheet.x - 8, y + 5, f"{ruler} m{note}", "end")


def sheet_of(ways: Iterable[Way]) -> tuple[Sheet, float]:
    """Fit the road into the picture; return how, and the height of the picture [px]."""
    points = np.concatenate([sides(way, side) for way in ways for side in (-2.0, 2.0)])
    (left, top), (right, low) = points.min(axis=0), points.max(axis=0)
    along = (WIDTH - 2 * MARGIN) / (right - left)
    if (low - top) * along < 80:
        return Sheet(left, top, along, ACROSS, MARGIN), (low - top) * ACROSS + 2 * MARGIN + KEY
    along = min(along, (TALLEST - 2 * MARGIN) / (low - top))
    indent = (WIDTH - (right - left) * along) / 2
    return Sheet(left, top, along, along, indent), (low - top) * along + 2 * MARGIN + KEY


def draw(name: str) -> str:
    """Return the picture of a scenario."""
    config = compose([f"scenario={name}"], EXAMPLE)
    scenario: Scenario = build(config["scenario"], object, "scenario", config["plugins"])
    roads = road_map(scenario.road)
    sheet, height = sheet_of(roads.paths.values())
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH:g} {height:.0f}" '
        'font-family="Helvetica, Arial, sans-serif">',
        f"<title>The road of scenario={name}, and where vehicles start</title>",
        f'<rect width="{WIDTH:g}" height="{height:.0f}" fill="{PAPER}"/>',
        *ground(sheet, roads),
        *routes(sheet, roads),
        *starts(sheet, scenario, roads),
        *names(sheet, roads),
        *key(roads, height - KEY, sheet),
        "</svg>",
    ]
    return "\n".join(parts) + "\n"


if __name__ == "__main__":
    for name in choices("scenario", EXAMPLE):
        (HERE / f"road-{name}.svg").write_text(draw(name), encoding="utf-8")
