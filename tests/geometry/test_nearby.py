"""Routes that pass by a place, against a search through all points of all paths."""

import math

import numpy as np
import pytest

from codriving.config.build import build
from codriving.config.choices import choices
from codriving.config.compose import compose
from codriving.environment.environment import Environment
from codriving.geometry import RoadMap


def plain(
    road_map: RoadMap, x: float, y: float, heading: float | None, tolerance: float, angle: float
) -> dict[str, float]:
    """The same by the nearest point of each path that has about this heading."""
    found = {}
    for name, path in road_map.paths.items():
        dx, dy = path.points[:, 0] - x, path.points[:, 1] - y
        square = dx * dx + dy * dy
        if heading is not None:
            towards = np.cos(path.headings) * math.cos(heading) + np.sin(path.headings) * math.sin(heading)
            square[towards < math.cos(angle)] = np.inf
        if square.min() <= (tolerance + 1.0) ** 2:
            s, lateral = path.project_at(int(square.argmin()), x, y)
            if abs(lateral) <= tolerance and -tolerance <= s <= path.length + tolerance:
                found[name] = s
    return found


@pytest.mark.parametrize("name", choices("scenario"))
@pytest.mark.parametrize(("tolerance", "angle"), [(2.0, math.pi / 3), (1.5, 0.35), (6.0, 0.35)])
def test_no_route_is_missed_and_none_is_added(name: str, tolerance: float, angle: float) -> None:
    config = compose([f"scenario={name}"])
    made = build(config["environment"], Environment, "environment", config["plugins"])
    road_map, rng = made.road_map, np.random.default_rng(3)
    paths = list(road_map.paths.values())
    hits = 0
    for k in range(150):
        path = paths[int(rng.integers(len(paths)))]
        row = int(rng.integers(len(path.points)))
        x, y = (path.points[row] + rng.normal(0.0, tolerance, 2)).tolist()
        heading = None if k % 5 == 0 else float(path.headings[row] + rng.normal(0.0, angle))
        found = dict(road_map.nearby.routes(x, y, heading, tolerance, angle))
        wanted = plain(road_map, x, y, heading, tolerance, angle)
        # Beside a lane that ends there may be its own route, too, which this search does not know.
        assert {route: s for route, s in found.items() if route in wanted} == wanted
        assert set(found) - set(wanted) <= {route for route, *_ in road_map.nearby._ending}
        hits += bool(wanted)
    assert hits > 40


def test_at_the_very_angle_and_between_two_points_nothing_is_different() -> None:
    config = compose([])
    road_map = build(config["environment"], Environment, "environment", config["plugins"]).road_map
    hits = 0
    for path in road_map.paths.values():
        for row in range(10, 90, 7):
            (x0, y0), (x1, y1) = path.points[row : row + 2].tolist()
            x, y = (x0 + x1) / 2, (y0 + y1) / 2
            for turned in (0.35, -0.35, 0.35 - 1e-12, 0.35 + 1e-12, 3 * math.tau, math.pi):
                heading = float(path.headings[row]) + turned
                found = dict(road_map.nearby.routes(x, y, heading, 1.5, 0.35))
                assert found == plain(road_map, x, y, heading, 1.5, 0.35)
                hits += bool(found)
    assert hits > 100


def test_far_from_every_road_there_is_none() -> None:
    config = compose([])
    road_map = build(config["environment"], Environment, "environment", config["plugins"]).road_map
    assert road_map.nearby.routes(1e4, -1e4, 0.0) == ()
