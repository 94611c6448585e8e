"""When a planned motion first comes too close to another vehicle: the one test of all plans.

Functions return the step of the first violation of each plan (plans,), or the number of steps where there is none.
"""

from dataclasses import dataclass

import numpy as np

from codriving.datatypes import Conflict, TrackedVehicle
from codriving.geometry import PLANNING, TRUE, Array, ConflictZone, Footprint, Steps, first_true, halts_behind
from codriving.reasoning.conflicts import has_joined, is_behind
from codriving.reasoning.exits import gets_out
from codriving.reasoning.perception import Moment
from codriving.reasoning.safety.conflict_lane import BODY

# Sizes of vehicles for planning; a smaller one is taken where vehicles are already closer together than the larger.
SIZES: tuple[Footprint, ...] = (PLANNING, BODY, TRUE)

SAME = 0.5  # Zones that begin no farther apart than this are the same, seen from either route [m]

ROOM = 0.5  # Room that a driver who gives way leaves to the zone [m]


def passes_too_early(zone: ConflictZone, ego: Array, first: Array, lag: int, pad: float) -> Steps:
    """Return when the second vehicle first enters a zone that the one before it has not left for long enough."""
    return first_true(np.concatenate([np.full(lag, first[0]), first])[: ego.shape[1]] <= zone.over_i.highest(ego) + pad)


def meets(zone: ConflictZone, ego: Array, low: Array, high: Array, lag: int, pad: float) -> Steps:
    """Return when a vehicle first touches the stretch on which another one may be."""
    n = ego.shape[1]
    least = np.concatenate([np.full(lag, low[0]), low])[:n]
    most = np.concatenate([high[lag:n], np.full(min(lag, n), high[n - 1])])
    begin, end = zone.over_i.blocked(ego)
    return first_true((begin - pad <= most) & (end + pad >= least))


@dataclass(frozen=True, slots=True)
class Meeting:
    """A stretch that two vehicles share, with its zones for each size of vehicles, the largest first."""

    zones: tuple[tuple[ConflictZone, ...], ...]
    place: float  # Arc length of the one that goes second [m]
    there: float  # Arc length of the one that goes first [m]
    until: int
    lag: int
    pad: float  # Additional room along the route [m]
    halts: float = 0.0  # Time between two samples if it must be able to stop behind, too [s]

    def steps(self, travels: Array, first: Array) -> Steps:
        """Return when each plan (plans, n) [m] first comes too close to the one that goes first (n,) [m]."""
        n = travels.shape[1]
        for k, zones in enumerate(self.zones):
            # As long as the bodies have room the margins stay; a vehicle that is closer than that may only get away.
            lag, pad = (self.lag, self.pad) if k < 2 else (0, 0.0)
            found: Steps = np.full(len(travels), n)
            for zone in zones:
                steps = passes_too_early(zone, self.place + travels[:, : self.until], self.there + first, lag, pad)
                found = np.minimum(found, np.where(steps < self.until, steps, n))
            if found.any():
                break
        if self.halts:
            halted = halts_behind(zones[0], self.place + travels, self.there + first, self.halts)
            found = np.where(halted, found, np.minimum(found, n - 1))
        return found

    @property
    def entries(self) -> tuple[float, float]:
        """Where it begins on the route of the one that goes second, and on that of the one that goes first [m]."""
        return self.zones[0][0].entry_i, self.zones[0][0].entry_j

    def is_at(self, entries: tuple[float, float]) -> bool:
        """Whether it is the stretch that begins there, seen from the other vehicle: first its own route [m]."""
        return all(abs(mine - theirs) < SAME for mine, theirs in zip(self.entries, entries[::-1], strict=True))

    def steps_ahead(self, travels: Array, first: Array) -> Steps:
        """Return when each plan (plans, n) [m] is first in the way of the other one (n,) [m] if it goes before it."""
        zone, lag = self.zones[0][0], self.lag
        mine = self.place + travels
        earlier = np.concatenate([np.repeat(mine[:, :1], lag, axis=1), mine[:, : mine.shape[1] - lag]], axis=1)
        return first_true(earlier <= zone.front(self.there + first) + self.pad)


def meetings_behind(
    moment: Moment, behind: TrackedVehicle, ahead: TrackedVehicle, lag: int, following: int, pad: float
) -> list[Meeting]:
    """Return where a vehicle drives behind another one; a lane that it is leaving counts until its body is off it.

    Where ways merge the margins of a conflict hold until it has joined the stretch behind the other one.
    """
    n, short, zones = moment.forecast.steps + 1, moment.forecast.clears, moment.road_map.zones
    sample = moment.forecast.sample if moment.forecast.model.steady else 0.0
    found = []
    for r, (route, place) in enumerate(behind.routes):
        until = short if r else n
        for other, there in ahead.routes:
            for zone in (z for z in zones(route, other) if is_behind(z, place, there)):
                if has_joined(zone, place):
                    found.append(Meeting(((zone,),), place, there, until, following, 0.0, 0.0 if r else sample))
                else:
                    sizes = ((zone,), *(zones(route, other, size) for size in SIZES[1:]))
                    found.append(Meeting(sizes, place, there, until, lag, pad, 0.0 if r else sample))
    return found


def minds_humans(moment: Moment, ego: TrackedVehicle, travels: Array, lag: int, following: int, pad: float) -> Steps:
    """Return when each plan of a CAV first comes too close to a human driver.

    A driver behind on the same way has to mind the CAV, not the other way round; one who gives way, by standing or by
    the rules of the road, is expected to stay before the zone.
    """
    found: Steps = np.full(len(travels), travels.shape[1])
    people = {m.id: m for m in moment.vehicles[ego.id].values() if not m.is_cav}
    # A false place, as a CAV may tell it, can be on no route.
    for other in (m for m in people.values() if m.routes):
        low = np.min([moment.forecast.likely_of(other, way)[0] for way in other.routes], axis=0)
        for meeting in meetings_behind(moment, ego, other, lag, following, pad):
            found = np.minimum(found, meeting.steps(travels, low))
    for c in moment.conflicts[ego.id]:
        if c.other in people and not gets_out(moment, ego, people[c.other], False):
            found = np.minimum(found, _in_zone(moment, c, people[c.other], travels, lag, pad))
    return found


def _in_zone(moment: Moment, c: Conflict, other: TrackedVehicle, travels: Array, lag: int, pad: float) -> Steps:
    place, there = c.places
    low, high = moment.forecast.likely_of(other, (c.routes[1], there))
    yields = moment.gives_way(c, other, moment.road_map)
    steps: Steps = np.zeros(len(travels), dtype=np.int64)
    # Beside a driver who gives way the bodies have to keep clear, no more.
    for size in SIZES[1:] if yields else SIZES:
        whole, apart = size is PLANNING, not yields and size is not TRUE
        # One zone of the larger footprint may be several of the smaller one.
        zones = moment.road_map.zones(*c.routes, size)
        for zone in (zones[c.zone],) if whole else zones:
            room = max(zone.entry_j - there - ROOM, 0.0) if yields else np.inf
            touched = meets(
                zone,
                place + travels,
                there + np.minimum(low, room),
                there + np.minimum(high, room),
                lag if apart else 0,
                pad if apart else 0.0,
            )
            steps = touched if zone is zones[0] or whole else np.minimum(steps, touched)
        if steps.any() or not zones:
            return steps if zones else np.full(len(travels), travels.shape[1])
    return steps
