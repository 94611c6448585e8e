"""Where two CAVs cannot be at the same time, and what follows for who passes when."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations, product

import numpy as np
from numpy.typing import NDArray

from codriving.bound.envelope import BIN, Envelope
from codriving.bound.passing import Passing
from codriving.geometry import (
    PLANNING,
    TRUE,
    ConflictZone,
    FloatArray,
    FollowingBand,
    Footprint,
    Path,
    RoadMap,
    collision_set,
    separation,
)

BoolArray = NDArray[np.bool_]

ROWS = 10  # Places of a meeting that are kept, for each of the two orders; any of them are a bound

Rows = tuple[tuple[float, float], ...]  # Places of the second and of the first: there after the first is here [m]


@dataclass(frozen=True, slots=True)
class MeetingPlace:
    """One connected part of two routes that two CAVs pass one after the other."""

    i: int
    j: int
    first: int | None  # Which of the two has to go first because of where they start; None if either can
    rows_i: Rows  # If i goes first: places of j and of i
    rows_j: Rows  # If j goes first: places of i and of j

    def rows(self, first: int) -> Rows:
        """Return what holds if one of the two goes first."""
        return self.rows_i if first == self.i else self.rows_j


@dataclass(frozen=True, slots=True)
class Margins:
    """What an executor keeps between CAVs beyond not touching."""

    time: float = 0.6  # Time between one's leaving a zone and the next one's entering it [s]
    pad: float = 1.0  # Additional room along the route where ways do not run together [m]
    footprint: Footprint = PLANNING


def sure_meetings(cavs: Sequence[Passing], road_map: RoadMap, step: float) -> Iterator[MeetingPlace]:
    """Give the meetings of true bodies in which they overlap however they lie within their envelopes."""
    for i, j in combinations(range(len(cavs)), 2):
        one, other = cavs[i], cavs[j]
        jump = float(np.ceil(1000 * step * max(one.fastest, other.fastest))) / 1000
        mask = sure_overlap(road_map, one.route.id, other.route.id, one.envelope, other.envelope, jump)
        spacings = tuple(road_map.paths[cav.route.id].spacing for cav in (one, other))
        yield from _of_mask(i, j, one, other, mask, spacings)


@lru_cache(maxsize=1024)
def sure_overlap(
    road_map: RoadMap, route_i: str, route_j: str, envelope_i: Envelope, envelope_j: Envelope, jump: float
) -> BoolArray:
    """Return at which pairs of path points bodies cannot be, nor pass between two looks, a jump apart at most [m]."""
    if route_i > route_j:
        return sure_overlap(road_map, route_j, route_i, envelope_j, envelope_i, jump).T
    path_i, path_j = road_map.paths[route_i], road_map.paths[route_j]
    cells = collision_set(path_i, path_j, TRUE)
    mask = np.zeros((len(path_i.points), len(path_j.points)), dtype=np.bool_)
    if len(cells.i):
        inside = np.ones(len(cells.i), dtype=np.bool_)
        for pose_i, pose_j in product(_poses(envelope_i, path_i, cells.i), _poses(envelope_j, path_j, cells.j)):
            inside &= _overlaps(pose_i, pose_j)
        mask[cells.i[inside], cells.j[inside]] = True
        mask = between_looks(mask, jump / path_i.spacing, jump / path_j.spacing)
    mask.setflags(write=False)
    return mask


Pose = tuple[FloatArray, FloatArray, FloatArray]  # x and y [m], heading [rad]


def _poses(envelope: Envelope, path: Path, points: NDArray[np.intp]) -> list[Pose]:
    """The extreme poses at path points, and on each side one with a heading between the extremes."""
    rows = np.minimum((points * path.spacing / BIN).astype(np.intp), len(envelope.pace) - 1)
    heading, (x, y) = path.headings[points], path.points[points].T
    middle = (envelope.least_turn + envelope.most_turn) / 2
    sides = [*envelope.corners, (envelope.left, middle), (envelope.right, middle)]
    return [
        (x - side[rows] * np.sin(heading), y + side[rows] * np.cos(heading), heading + turn[rows])
        for side, turn in sides
    ]


def _overlaps(one: Pose, other: Pose) -> BoolArray:
    (x, y, heading), (x2, y2, heading2) = one, other
    cos, sin, dx, dy, turn = np.cos(heading), np.sin(heading), x2 - x, y2 - y, heading2 - heading
    return np.asarray(separation(cos * dx + sin * dy, cos * dy - sin * dx, np.cos(turn), np.sin(turn), TRUE) < 0)


def between_looks(mask: BoolArray, jump_i: float, jump_j: float) -> BoolArray:
    """Keep of a forbidden set what no straight line between two looks passes, if both looks are outside the set.

    Such a line ends within half a jump past the point or begins within half a jump before it; and it ends within a
    whole jump past it, and begins within a whole jump before it. So a point counts if both half jumps around it are
    forbidden, or all of the jump past it, or all of the jump before it.
    """
    whole, half = ((int(np.ceil(jump_i * k)), int(np.ceil(jump_j * k))) for k in (1.0, 0.5))
    past, before = _shifted_all(mask, whole, 1), _shifted_all(mask, whole, -1)
    return past | before | (_shifted_all(mask, half, 1) & _shifted_all(mask, half, -1))


def _shifted_all(mask: BoolArray, reach: tuple[int, int], sign: int) -> BoolArray:
    found = mask.copy()
    for axis, steps in enumerate(reach):
        kept = found.copy()
        for k in range(1, steps + 1):
            moved = np.zeros_like(found)
            source, target = (slice(k, None), slice(None, -k)) if sign > 0 else (slice(None, -k), slice(k, None))
            moved[(target, slice(None)) if axis == 0 else (slice(None), target)] = found[
                (source, slice(None)) if axis == 0 else (slice(None), source)
            ]
            kept &= moved
        found = kept
    return found


def _of_mask(
    i: int, j: int, one: Passing, other: Passing, mask: BoolArray, spacings: tuple[float, ...]
) -> Iterator[MeetingPlace]:
    """Give the connected parts of a forbidden set that lie ahead of both and before both goals."""
    from scipy.ndimage import label

    low = [int(cav.start.position / spacing) for cav, spacing in zip((one, other), spacings, strict=True)]
    high = [int(cav.route.goal / spacing) + 1 for cav, spacing in zip((one, other), spacings, strict=True)]
    ahead = mask[low[0] : high[0], low[1] : high[1]]
    if not ahead.any():
        return
    parts, count = label(ahead)
    for k in range(1, count + 1):
        part = parts == k
        # Who stands in the column of a part, or past it, while the other is still before it, goes first.
        i_leads, j_leads = bool(part[0].any()), bool(part[:, 0].any())
        if i_leads and j_leads:
            continue
        first = i if i_leads else j if j_leads else None
        rows_i = _records(part.T, (low[1], low[0]), (spacings[1], spacings[0]))
        rows_j = _records(part, (low[0], low[1]), spacings)
        here, there = one.start.position, other.start.position
        yield MeetingPlace(i, j, first, _ahead(rows_i, there, here), _ahead(rows_j, here, there))


def _records(part: BoolArray, low: tuple[int, int], spacings: Sequence[float]) -> list[tuple[float, float]]:
    """Return at which rows the end of what is forbidden on the other route gets farther, and where that end is."""
    rows = np.flatnonzero(part.any(axis=1))
    ends = part.shape[1] - 1 - part[rows, ::-1].argmax(axis=1)
    records = np.flatnonzero(np.diff(np.maximum.accumulate(ends), prepend=-1) > 0)
    return [((low[0] + int(rows[k])) * spacings[0], (low[1] + int(ends[k])) * spacings[1]) for k in records]


def _ahead(rows: Sequence[tuple[float, float]], second: float, first: float) -> Rows:
    """Keep what is ahead of both, and of that as much as is wanted, evenly."""
    ahead = [row for row in rows if row[0] > second and row[1] > first]
    if len(ahead) <= ROWS:
        return tuple(ahead)
    return tuple(ahead[round(k * (len(ahead) - 1) / (ROWS - 1))] for k in range(ROWS))


def kept_meetings(cavs: Sequence[Passing], road_map: RoadMap, margins: Margins) -> Iterator[MeetingPlace]:
    """Give the meetings of an executor that keeps margins, zone by zone."""
    for i, j in combinations(range(len(cavs)), 2):
        one, other = cavs[i], cavs[j]
        for zone in road_map.zones(one.route.id, other.route.id, margins.footprint):
            rows_i = list(_rows_of(zone, other.start.position, one, other, margins.pad))
            rows_j = list(_rows_of(zone.mirrored(), one.start.position, other, one, margins.pad))
            here, there = one.start.position, other.start.position
            i_leads = any(a <= here and b > there for a, b in rows_j)
            j_leads = any(b <= there and a > here for b, a in rows_i)
            if i_leads and j_leads:
                continue
            first = i if i_leads else j if j_leads else None
            yield MeetingPlace(i, j, first, _ahead(_rising(rows_i), there, here), _ahead(_rising(rows_j), here, there))


def _rows_of(
    zone: ConflictZone, place: float, first: Passing, second: Passing, pad: float
) -> Iterator[tuple[float, float]]:
    """The rows of a zone if the first one of the two goes first: where the second is, and where the first has left."""
    band, goal = zone.over_j, first.route.goal
    joined = zone.merge_j if zone.split_j is None else min(zone.merge_j or 0.0, zone.split_j)
    if isinstance(band, FollowingBand):
        places = np.arange(np.floor(place), second.route.goal, 1.0)
        yield from ((float(b), min(float(b) + band.body, goal)) for b in places)
        return
    for k, high in enumerate(band.high.tolist()):
        b = band.start + k * band.spacing
        if b <= second.route.goal:
            room = pad if joined is None or b < joined else 0.0
            yield b, min(high + room, goal)


def _rising(rows: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    best, found = -np.inf, []
    for row in rows:
        if row[1] > best:
            best = row[1]
            found.append(row)
    return found
