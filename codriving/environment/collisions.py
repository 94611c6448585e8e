"""Collisions by the true footprints, and which of the two vehicles is responsible."""

import math
from itertools import islice

from highway_env.vehicle.objects import RoadObject

from codriving.datatypes import Collision
from codriving.environment.traffic.route_following import RouteFollower
from codriving.geometry import FloatArray, corners, overlap

PLAINLY = 1e-6  # A gap of more than this is one, however it is rounded [m]

PUSHED = 3.0  # How far highway-env pushes two crashed cars apart at most [m]


def find_collisions(
    vehicles: list[RouteFollower], time: float, dt: float, by_footprint: bool
) -> list[tuple[tuple[RouteFollower, ...], Collision]]:
    """Find every pair of vehicles that have collided."""
    found: list[tuple[tuple[RouteFollower, ...], Collision]] = []
    for one, other in _near_pairs(vehicles, 0.0 if by_footprint else PUSHED):
        if by_footprint:
            collided = not (_beside(one, other) or _beside(other, one)) and _overlap(one, other)
        else:
            collided = one.crashed and other.crashed
        if collided:
            striker, struck = responsibility(one, other, dt)
            pair = "-".join(sorted((one.kind, other.kind)))
            found.append(((striker, struck), Collision(time, striker.id, struck.id, pair)))
    return found


def _near_pairs(vehicles: list[RouteFollower], pushed: float) -> list[tuple[RouteFollower, RouteFollower]]:
    """Return the pairs of vehicles that may touch, in their order."""
    placed = [(*v.position.tolist(), float(v.diagonal) / 2, k) for k, v in enumerate(vehicles)]
    placed.sort()
    longest, pairs = max((half for _, _, half, _ in placed), default=0.0), []
    for place, (x, y, half, k) in enumerate(placed, start=1):
        for x2, y2, half2, k2 in islice(placed, place, None):
            dx, dy, reach = x2 - x, y2 - y, half + half2 + pushed
            if dx > half + longest + pushed:
                break
            if dx * dx + dy * dy <= reach * reach:
                pairs.append((min(k, k2), max(k, k2)))
    return [(vehicles[k], vehicles[k2]) for k, k2 in sorted(pairs)]


def _beside(one: RouteFollower, other: RouteFollower) -> bool:
    """Whether a vehicle is plainly beside the other one, ahead of it or behind, by more than rounding can change."""
    (x, y), (x2, y2) = one.position.tolist(), other.position.tolist()
    (cos, sin), (cos2, sin2), dx, dy = one.facing(), other.facing(), x2 - x, y2 - y
    c, s = abs(cos * cos2 + sin * sin2), abs(sin * cos2 - cos * sin2)
    long, wide = other.LENGTH / 2, other.WIDTH / 2
    across = abs(dy * cos - dx * sin) - one.WIDTH / 2 - (s * long + c * wide)
    along = abs(dx * cos + dy * sin) - one.LENGTH / 2 - (c * long + s * wide)
    return bool(max(across, along) > PLAINLY)


def find_block_collisions(
    vehicles: list[RouteFollower], obstacles: list[RoadObject], time: float, by_footprint: bool
) -> list[tuple[tuple[RouteFollower, ...], Collision]]:
    """Find every vehicle that has run into something solid that stands on the road."""
    found: list[tuple[tuple[RouteFollower, ...], Collision]] = []
    for k, obstacle in enumerate(obstacles, start=1):
        for vehicle in vehicles:
            if abs(vehicle.position[0] - obstacle.position[0]) > vehicle.diagonal + obstacle.diagonal:
                continue
            if _overlap(vehicle, obstacle) if by_footprint else vehicle.crashed and obstacle.crashed:
                found.append(((vehicle,), Collision(time, vehicle.id, f"block{k}", f"{vehicle.kind}-block")))
    return found


def _overlap(one: RoadObject, other: RoadObject) -> bool:
    return overlap(*[corners(v.position[0], v.position[1], v.heading, v.LENGTH, v.WIDTH) for v in (one, other)])


HALVINGS = 20  # Bisections of a simulation step; finds the first touch to a micrometre

CORNER = 0.1  # A contact this close to the front edge is at the front, even at the very corner [m]

MOVING = 0.1  # Slower vehicles do not strike others [m/s]

Point = tuple[float, float]


def responsibility(one: RouteFollower, other: RouteFollower, dt: float) -> tuple[RouteFollower, RouteFollower]:
    """Return the striker and the struck.

    A vehicle strikes if its front is in the contact and the other one's front is not. Else, as when two meet head-on or
    scrape along each other, it is the one that moved faster towards the other.
    """
    back = _since_touch(one, other, dt)
    contact = _contact(one, other, back)
    fronts = [_at_front(vehicle, contact, back) and vehicle.speed > MOVING for vehicle in (one, other)]
    if fronts[0] != fronts[1]:
        return (one, other) if fronts[0] else (other, one)
    (x, y), (x2, y2) = _centre(one, back), _centre(other, back)
    dx, dy = x2 - x, y2 - y
    towards_other = one.speed * (math.cos(one.heading) * dx + math.sin(one.heading) * dy)
    towards_one = -other.speed * (math.cos(other.heading) * dx + math.sin(other.heading) * dy)
    return (one, other) if towards_other >= towards_one else (other, one)


def _centre(vehicle: RouteFollower, back: float) -> Point:
    """Return where a vehicle was some time ago [s], at its present velocity."""
    way = vehicle.speed * back
    x, y = vehicle.position.tolist()
    return x - way * math.cos(vehicle.heading), y - way * math.sin(vehicle.heading)


def _box(vehicle: RouteFollower, back: float) -> FloatArray:
    return corners(*_centre(vehicle, back), vehicle.heading, vehicle.LENGTH, vehicle.WIDTH)


def _since_touch(one: RouteFollower, other: RouteFollower, dt: float) -> float:
    """Return how long ago the two began to overlap [s]; 0 if their velocities do not say."""

    def overlapped(back: float) -> bool:
        return overlap(_box(one, back), _box(other, back))

    if overlapped(dt):
        return 0.0
    touching, apart = 0.0, dt
    for _ in range(HALVINGS):
        middle = (touching + apart) / 2
        if overlapped(middle):
            touching = middle
        else:
            apart = middle
    return touching


def _contact(one: RouteFollower, other: RouteFollower, back: float) -> Point:
    """Return the middle of the ground that both cover."""
    polygon, box = ([(x, y) for x, y in _box(vehicle, back).tolist()] for vehicle in (one, other))
    for k in range(4):
        polygon = _cut(polygon, box[k], box[(k + 1) % 4])
    if not polygon:
        polygon = [_centre(one, back), _centre(other, back)]
    return sum(x for x, _ in polygon) / len(polygon), sum(y for _, y in polygon) / len(polygon)


def _cut(polygon: list[Point], a: Point, b: Point) -> list[Point]:
    """Return the part of a polygon on the inner side of the edge from a to b (Sutherland and Hodgman, 1974)."""

    def side(p: Point) -> float:
        # Corners run from front right to front left, against the clock where y grows to the right.
        return (b[1] - a[1]) * (p[0] - a[0]) - (b[0] - a[0]) * (p[1] - a[1])

    kept = []
    for k, p in enumerate(polygon):
        q = polygon[k - 1]
        at_p, at_q = side(p), side(q)
        if (at_p > 0) != (at_q > 0):
            t = at_q / (at_q - at_p)
            kept.append((q[0] + t * (p[0] - q[0]), q[1] + t * (p[1] - q[1])))
        if at_p > 0:
            kept.append(p)
    return kept


def _at_front(vehicle: RouteFollower, contact: Point, back: float) -> bool:
    """Whether a point on the ground lies at the front of a vehicle rather than at its sides or rear."""
    x, y = _centre(vehicle, back)
    dx, dy = contact[0] - x, contact[1] - y
    along = dx * math.cos(vehicle.heading) + dy * math.sin(vehicle.heading)
    across = abs(dy * math.cos(vehicle.heading) - dx * math.sin(vehicle.heading))
    return bool(vehicle.LENGTH / 2 - along <= max(vehicle.WIDTH / 2 - across, 0.0) + CORNER)
