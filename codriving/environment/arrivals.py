"""Who wants to come in when: drawn beforehand, lane by lane, and held outside while there is no room."""

import math
from collections import deque
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from string import ascii_lowercase

import numpy as np
from highway_env.road.lane import AbstractLane

from codriving.datatypes import Flow, Kind, LaneId, Scenario, Start
from codriving.environment.scenarios.placement import LENGTH, braking_gap
from codriving.environment.traffic.traffic import Traffic


@dataclass(frozen=True, slots=True)
class Newcomer:
    """A vehicle that wants to come in."""

    time: float  # When it wants to [s]
    lane: LaneId
    start: Start


def entries(scenario: Scenario) -> dict[LaneId, tuple[str, ...]]:
    """Return the lanes that lead into the road of a scenario, and the routes on which vehicles come in there."""
    found: dict[LaneId, tuple[str, ...]] = {}
    for route in scenario.ways:
        found[route.lanes[0]] = (*found.get(route.lanes[0], ()), route.id)
    return found


def draw_newcomers(scenario: Scenario, flow: Flow, seed: int, interval: float) -> tuple[Newcomer, ...]:
    """Draw all vehicles of a flow.

    Times between them are the smallest headway and an exponential rest (shifted exponential; Cowan, 1975). The process
    is stationary: the time to the first arrival is drawn as if it had begun long before. Each lane has random numbers
    of its own, and what is drawn for a vehicle does not depend on the share of CAVs.

    Args:
        interval: Vehicles come in when the CAVs decide, every so often [s]; times are rounded up to that.
    """
    found = []
    for number, (lane, routes) in enumerate(entries(scenario).items()):
        key = "/".join(map(str, lane)).encode()
        times, traits = (
            np.random.default_rng(np.random.SeedSequence(entropy=seed, spawn_key=(3, part, *key))) for part in (0, 1)
        )
        time, count = _first(times, flow), 0
        while time < flow.ends:
            count += 1
            kind = Kind.CAV if float(traits.random()) < flow.share else Kind.HDV
            route = routes[int(traits.integers(len(routes)))]
            start = scenario.arrival(traits, f"{kind}{count}{_letters(number)}", kind, route)
            looked = math.ceil(time / interval - 1e-9) * interval
            if looked < flow.ends:
                found.append(Newcomer(round(looked, 9), lane, start))
            time += flow.headway + float(times.exponential(flow.mean_gap - flow.headway))
    return tuple(sorted(found, key=lambda newcomer: (newcomer.time, newcomer.lane)))


def _first(rng: np.random.Generator, flow: Flow) -> float:
    """Draw the time to the next arrival at any moment [s]: its density is the share of longer gaps, over their mean."""
    within, chance = flow.headway / flow.mean_gap, float(rng.random())
    if chance < within:
        return chance * flow.mean_gap
    return flow.headway + float(rng.exponential(flow.mean_gap - flow.headway))


def _letters(number: int) -> str:
    """Name a lane: a to z, aa, ab, ..."""
    before = _letters(number // 26 - 1) if number >= 26 else ""
    return before + ascii_lowercase[number % 26]


class Outside:
    """Those who have not come in yet; on each lane they come in one after another."""

    def __init__(self, newcomers: Iterable[Newcomer], lanes: Mapping[LaneId, AbstractLane]) -> None:
        self._lanes = lanes
        self._queues: dict[LaneId, deque[Newcomer]] = {lane: deque() for lane in lanes}
        for newcomer in newcomers:
            self._queues[newcomer.lane].append(newcomer)

    def come_in(self, traffic: Traffic, time: float) -> list[Start]:
        """Take from the queues who wants to come in and has room to brake behind those ahead."""
        found = []
        for lane, queue in self._queues.items():
            if queue and queue[0].time <= time + 1e-9 and _has_room(queue[0].start, self._lanes[lane], traffic):
                found.append(queue.popleft().start)
        return found


def _has_room(start: Start, lane: AbstractLane, traffic: Traffic) -> bool:
    for vehicle in traffic.vehicles:
        s, aside = lane.local_coordinates(vehicle.position)
        if not 0 <= s <= lane.length or abs(aside) > (lane.width + vehicle.WIDTH) / 2:
            continue
        gap = s - start.position - (LENGTH + vehicle.LENGTH) / 2
        if gap < braking_gap(start.speed, vehicle.speed):
            return False
    return True
