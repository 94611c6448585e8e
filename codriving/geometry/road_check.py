"""What a road must fulfil before anything can drive on it."""

import math
from collections import Counter
from collections.abc import Iterable
from itertools import pairwise

from codriving.datatypes import Arc, Lane, Road, Route, beside
from codriving.errors import ScenarioError
from codriving.geometry.curve import lane_curve
from codriving.geometry.lane_path import end_of, lane_path, route_path
from codriving.geometry.sight import Sight

_LONGEST_GAP = 15.0  # Longest gap between two lanes that is bridged [m]

_SIDEWAYS = math.radians(60.0)  # Steepest direction over a gap against the heading of either lane [rad]

_ROUGH = 0.5  # Gaps shorter than this may lie in any direction [m]


def check_road(road: Road) -> None:
    """Refuse a road that is not consistent in itself."""
    if not road.routes:
        raise ScenarioError(f"road {road.name!r} has no routes; no vehicle could drive on it")
    _unique(road, "lane", (lane.id for lane in road.lanes))
    _unique(road, "route", (route.id for route in road.routes))
    for lane in road.lanes:
        _check_lane(road, lane)
        _check_buildings(road, lane)
    lanes = {lane.id: lane for lane in road.lanes}
    for route in road.routes:
        if not route.lanes:
            raise ScenarioError(f"route {route.id!r} of road {road.name!r} has no lanes; give it at least one")
        for lane_id in route.lanes:
            if lane_id not in lanes:
                unknown = f"uses lane {lane_id}, which does not exist; add the lane or correct the route"
                raise ScenarioError(f"route {route.id!r} of road {road.name!r} {unknown}")
        for one, two, three in zip(route.lanes, route.lanes[1:], route.lanes[2:], strict=False):
            if beside(one, two) and beside(two, three):
                raise ScenarioError(
                    f"route {route.id!r} of road {road.name!r} changes lanes from {one} to {two} to {three}; between "
                    "two nodes one lane change has room, so split the road or start the route on another lane"
                )
        for lane_id, next_id in pairwise(route.lanes):
            _check_joint(road, route, lanes[lane_id], lanes[next_id])
        length = route_path([lanes[lane_id] for lane_id in route.lanes], route.taper).length
        if not 0 <= route.entry <= route.goal <= length + 1e-6:
            raise ScenarioError(
                f"route {route.id!r} of road {road.name!r} must have 0 <= entry <= goal <= its length of "
                f"{length:.2f} m, got entry {route.entry:g} m and goal {route.goal:g} m"
            )


def _unique(road: Road, what: str, ids: Iterable[object]) -> None:
    for name, times in Counter(ids).items():
        if times > 1:
            raise ScenarioError(f"{what} id {name!r} is used {times} times on road {road.name!r}; ids must be unique")


def _check_lane(road: Road, lane: Lane) -> None:
    where = f"lane {lane.id} of road {road.name!r}"
    if isinstance(lane.shape, Arc) and not lane.shape.radius > 0:
        raise ScenarioError(f"{where} must have a radius > 0 m, got {lane.shape.radius:g}")
    if not isinstance(lane.shape, Arc) and lane.shape.start == lane.shape.end:
        raise ScenarioError(f"{where} starts and ends at {lane.shape.start}; give it a length")
    if isinstance(lane.shape, Arc) and not lane_curve(lane.shape).length > 0:
        raise ScenarioError(
            f"{where} turns against its direction; end_phase must be greater than start_phase if clockwise, "
            "else smaller"
        )
    if not lane.width > 0 or not lane.speed_limit > 0:
        raise ScenarioError(
            f"{where} must have a width and a speed limit > 0, got {lane.width:g} m and {lane.speed_limit:g} m/s"
        )


def _check_buildings(road: Road, lane: Lane) -> None:
    if not road.buildings:
        return
    x, y = lane_path(lane, spacing=1.0).points.T
    for building, covers in zip(road.buildings, Sight(road.buildings).covers(x, y, lane.width / 2), strict=True):
        if covers:
            raise ScenarioError(
                f"the building at {building.position} of road {road.name!r} reaches over lane {lane.id}; move it, or "
                "make it smaller"
            )


def _check_joint(road: Road, route: Route, lane: Lane, following: Lane) -> None:
    where = f"route {route.id!r} of road {road.name!r} goes from lane {lane.id} to lane {following.id}"
    if beside(lane.id, following.id):
        _check_change(where, route, lane, following)
        return
    if lane.id[1] != following.id[0]:
        raise ScenarioError(f"{where}, but the first ends at node {lane.id[1]!r} and the second begins elsewhere")
    x, y, heading = end_of(lane_curve(lane.shape), at_start=False)
    x2, y2, heading2 = end_of(lane_curve(following.shape), at_start=True)
    gap = math.hypot(x2 - x, y2 - y)
    if gap > _LONGEST_GAP:
        raise ScenarioError(f"{where} over a gap of {gap:.1f} m; at most {_LONGEST_GAP:g} m can be bridged")
    direction = math.atan2(y2 - y, x2 - x)
    turns = [abs(math.remainder(direction - h, math.tau)) for h in (heading, heading2)]
    if gap > _ROUGH and max(turns) > _SIDEWAYS:
        raise ScenarioError(
            f"{where}, which begins {gap:.1f} m away at an angle of {math.degrees(max(turns)):.0f} deg to the way of "
            f"travel; at most {math.degrees(_SIDEWAYS):.0f} deg can be driven"
        )


def _check_change(where: str, route: Route, lane: Lane, following: Lane) -> None:
    length = lane_curve(lane.shape).length
    if abs(lane.id[2] - following.id[2]) != 1:
        raise ScenarioError(f"{where}, which are not next to each other; change one lane at a time")
    if not 10.0 <= route.taper <= length:
        raise ScenarioError(
            f"{where} with a taper of {route.taper:g} m; it must be 10 m to the {length:.1f} m of the lane that is left"
        )
