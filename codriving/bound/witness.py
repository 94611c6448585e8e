"""A drive that is nearly as fast as the bound: orders of its timetable, an exact search for each CAV, and a check."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from codriving.bound.measure import Chooser, LoneDrive, LoneRoad
from codriving.bound.meetings import Margins
from codriving.bound.solve import Bound, lower_bound
from codriving.bound.world import BoundedWorld
from codriving.datatypes import Action, Ending, Start
from codriving.geometry import (
    ConflictZone,
    FloatArray,
    FollowingBand,
    Footprint,
    RoadMap,
    Search,
    SearchedDrive,
    overlaps,
)

# Bodies for which ways are kept clear; the next larger ones for two that touch nevertheless, since CAVs cut corners.
SIZES = tuple(Footprint(5.1 + more, 2.1 + more) for more in (0.0, 0.2, 0.4, 0.7, 1.0, 1.4))

# Room that a second timetable keeps: without any, who goes first hangs by tenths of a second that no drive can keep.
ROOM = Margins(0.3, 0.0, SIZES[0])

SWEEPS = 12  # Times that all CAVs are searched for, each past the drives of the others as they were

BETWEEN = 5  # Looks a simulation step when drives are checked, one every 0.02 s at 10 Hz

LOOKS_AHEAD = 60.0  # A drive that has not arrived by then is none [s]


@dataclass(frozen=True, slots=True)
class Witness:
    """A drive of all CAVs of a scene that succeeds."""

    total: float  # Sum of the arrivals, as the environment has them [s]
    plans: Mapping[str, tuple[Action, ...]]  # What each CAV decides, by id


@dataclass(slots=True)
class _Pair:
    """Two CAVs that meet, and how large their bodies are taken."""

    i: int
    j: int
    size: int = 0


def witness(world: BoundedWorld, seed: int, bound: Bound) -> Witness | None:
    """Look for a drive in the orders of a bound's timetable, and in those of one that keeps a little room.

    Returns:
        The faster one, human drivers left out. None if none was found: CAVs touch, wait for one another, or do not
        settle; or there is no timetable.
    """
    cavs = world.cavs(seed)
    roomy = lower_bound(cavs, world.environment.road_map, world.environment.driving_model.step, ROOM)
    road, starts = LoneRoad(world.environment), [cav.start for cav in cavs]
    searches = [_search(world, road, start) for start in starts]
    tried = [_in_orders(road, starts, searches, one) for one in (bound, roomy) if one.times]
    return min((found for found in tried if found is not None), key=lambda found: found.total, default=None)


def _in_orders(road: LoneRoad, starts: Sequence[Start], searches: Sequence[Search], bound: Bound) -> Witness | None:
    """Look for a drive in the orders of one timetable; who touches another one is taken larger."""
    pairs = [_Pair(i, j) for i, j in combinations(range(len(starts)), 2)]
    order = np.argsort([times[1, -1] for times in bound.times], kind="stable").tolist()
    for _ in SIZES:
        drives = _settled(road.road_map, starts, searches, pairs, bound, order)
        if drives is None:
            return None
        real = [road.drive(start, _following(drive)) for start, drive in zip(starts, drives, strict=True)]
        touching = [pair for pair in pairs if _touch(real[pair.i], real[pair.j])]
        if not touching:
            return _driven(road, starts, {s.id: drive.plan for s, drive in zip(starts, drives, strict=True)})
        for pair in touching:
            pair.size += 1
            if pair.size == len(SIZES):
                return None
    return None


def _search(world: BoundedWorld, road: LoneRoad, start: Start) -> Search:
    """What a CAV may do; how far it gets along the route a metre driven is seen from the drive that is fastest."""
    fastest = road.drive(start, lambda _: Action.FASTER)
    model, route = world.environment.driving_model, road.road_map.routes[start.route]
    metres = np.arange(np.ceil(fastest.places[-1]) + 1)
    gained = np.diff(np.interp(metres, fastest.places, fastest.driven), append=fastest.driven[-1] + 1)
    stretch = np.where((metres >= start.position) & (gained > 0.5), 1 / np.maximum(gained, 0.5), 1.0)
    speeds = model.target_speeds
    nearest = min(speeds, key=lambda speed: abs(speed - start.speed))
    profile = road.road_map.speed_profiles(model).get(start.route)
    return Search(model, start.position, start.speed, nearest, route.goal, profile=profile, stretch=stretch)


def _settled(
    road_map: RoadMap,
    starts: Sequence[Start],
    searches: Sequence[Search],
    pairs: Sequence[_Pair],
    bound: Bound,
    order: Sequence[int],
) -> list[SearchedDrive] | None:
    """Search for all CAVs again and again, until none changes its drive."""
    steps = round(LOOKS_AHEAD / searches[0].model.step)
    behind = _behind(road_map, starts, pairs, bound)
    found: list[SearchedDrive | None] = [None] * len(starts)
    before: dict[int, FloatArray] = {}
    for _ in range(SWEEPS):
        changed = False
        for cav in order:
            walls = [
                _wall(zone, drive, searches[cav].place, steps)
                for first, zone in behind[cav]
                if (drive := found[first]) is not None
            ]
            wall = np.minimum.reduce([np.full(steps + 1, np.inf), *walls])
            if cav in before and np.array_equal(before[cav], wall):
                continue
            before[cav], changed = wall, True
            own = searches[cav]
            drive = replace(own, low=(wall,), high=(np.full(steps + 1, np.inf),)).drive(steps)
            if drive is None or drive.arrives is None:
                return None
            found[cav] = drive
        if not changed:
            return [drive for drive in found if drive is not None]
    return None


def _behind(
    road_map: RoadMap, starts: Sequence[Start], pairs: Sequence[_Pair], bound: Bound
) -> list[list[tuple[int, ConflictZone]]]:
    """Say whom each CAV lets go first, and in which zones; those are seen from the one that goes first."""
    found: list[list[tuple[int, ConflictZone]]] = [[] for _ in starts]
    for pair in pairs:
        one, other = starts[pair.i], starts[pair.j]
        for zone in road_map.zones(one.route, other.route, SIZES[pair.size]):
            first = _first(zone, pair, one, other, bound)
            if first == pair.i:
                found[pair.j].append((pair.i, zone))
            elif first == pair.j:
                found[pair.i].append((pair.j, zone.mirrored()))
    return found


def _first(zone: ConflictZone, pair: _Pair, one: Start, other: Start, bound: Bound) -> int | None:
    """Who goes first in a zone: the one that is ahead already, or that the timetable has pass its middle first."""
    if one.position >= zone.exit_i or other.position >= zone.exit_j:
        return None
    if one.route == other.route:
        return pair.i if one.position > other.position else pair.j
    # What i blocks at its start begins where j has not come yet, and the other way round.
    low_i, low_j = float(zone.over_i.lowest(one.position)), float(zone.over_j.lowest(other.position))
    i_leads, j_leads = other.position < low_i < np.inf, one.position < low_j < np.inf
    if i_leads != j_leads:
        return pair.i if i_leads else pair.j
    passes = (_passes(bound.times[pair.i], zone.point_i), _passes(bound.times[pair.j], zone.point_j))
    return pair.i if passes[0] <= passes[1] else pair.j


def _passes(times: FloatArray, place: float) -> float:
    return float(np.interp(place, times[0], times[1]))


def _wall(zone: ConflictZone, first: SearchedDrive, place: float, steps: int) -> FloatArray:
    """Return how far the second one may be at each step, until the first has left a zone (steps + 1,) [m]."""
    there = np.full(steps + 1, np.inf)
    until = len(first.places) if first.arrives is None else first.arrives + 1
    there[:until] = first.places[:until]
    band = zone.over_j
    if isinstance(band, FollowingBand):
        return np.asarray(there - band.body)
    # Where one is in the zone already, what is behind it does not matter.
    rows = np.arange(len(band.high) + 1)
    edges = band.start + band.spacing * (rows - 1)
    middles = edges + band.spacing / 2
    blocks = np.where(middles > place, band.highest(middles), -np.inf)
    reached = np.maximum.accumulate(blocks)
    first_blocked = np.searchsorted(reached, there, side="left")
    return np.where(first_blocked < len(edges), edges[np.minimum(first_blocked, len(edges) - 1)], np.inf)


def _following(drive: SearchedDrive) -> Chooser:
    return lambda step: drive.plan[min(step, len(drive.plan) - 1)]


def _touch(one: LoneDrive, other: LoneDrive) -> bool:
    """Whether two drives touch at some time before one of them has arrived."""
    steps = min(len(one.corners), len(other.corners))
    if steps < 2:
        return False
    between = list(_between(one.corners[:steps])), list(_between(other.corners[:steps]))
    return any(bool(overlaps(a, b).any()) for a, b in zip(*between, strict=True))


def _between(corners: FloatArray) -> Iterator[FloatArray]:
    for k in range(BETWEEN):
        share = k / BETWEEN
        yield (1 - share) * corners[:-1] + share * corners[1:]
    yield corners[-1:]


def _driven(road: LoneRoad, starts: Sequence[Start], plans: Mapping[str, tuple[Action, ...]]) -> Witness | None:
    """Drive all together in the environment, without human drivers."""
    outcome = road.together(starts, plans)
    if outcome is None or outcome.ending is not Ending.SUCCESS:
        return None
    return Witness(round(sum(outcome.arrivals.values()), 6), plans)
