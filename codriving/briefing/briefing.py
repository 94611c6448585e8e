"""The outlook of a CAV: what follows from each action, when others pass, and what is known of human drivers."""

from collections.abc import Iterator
from dataclasses import replace
from math import hypot, inf

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes import (
    Action,
    ActionOutlook,
    Conflict,
    ExpectedPassage,
    HumanOutlook,
    Outlook,
    Role,
    TrackedVehicle,
)
from codriving.reasoning import LONGITUDINAL, SIDES, Moment, SafetyInput, forced_braking, full_exit, is_behind

AGO = 1.0  # How long ago the speed was with which that of now is compared [s]

KEPT = 1.5  # Older speeds are not told as those of that time [s]

FOLLOWS = 40.0  # A vehicle follows another one within this free distance [m]

STANDS = 0.5  # Below this speed a vehicle stands [m/s]

LENGTH = 5.0  # How far down the common stretch a vehicle is that has merged [m]


class Briefing:
    """Looks at the situations of one episode."""

    def __init__(self) -> None:
        self._speeds: dict[str, list[tuple[float, float]]] = {}

    def note(self, moment: Moment) -> None:
        """Remember how fast human drivers are."""
        now = moment.time
        humans = {v.id: v.speed for known in moment.vehicles.values() for v in known.values() if not v.is_cav}
        for name, speed in humans.items():
            known = [(time, v) for time, v in self._speeds.get(name, ()) if now - KEPT <= time < now]
            self._speeds[name] = [*known, (now, speed)]

    def outlook(self, given: SafetyInput) -> Outlook:
        """Return what one CAV is to be told."""
        others: dict[str, Conflict] = {}
        for c in given.conflicts:
            others.setdefault(c.other, c)
        known = given.scene.neighbours
        humans = [self._human(given, n, others[n.id]) for n in known if n.id in others and not n.is_cav]
        passages = tuple(_passage(given, c) for c in given.conflicts)
        return Outlook(tuple(_actions(given)), passages, tuple(humans), tuple(_norms(given)))

    def _human(self, given: SafetyInput, n: TrackedVehicle, c: Conflict) -> HumanOutlook:
        road_map = given.road_map
        behind, gap = _leader(given, n)
        past = [speed for time, speed in self._speeds.get(n.id, ()) if time <= given.moment.time - AGO + 1e-6]
        return HumanOutlook(
            id=n.id,
            speed=n.speed,
            speed_before=past[-1] if past else None,
            acceleration=n.acceleration,
            standing=n.standing,
            turns=tuple(str(road_map.routes[route].turn) for route, _ in n.routes),
            first_by_rule=_first_by_rule(given, c),
            gives_way=given.moment.gives_way(c, n, road_map),
            braking=n.speed**2 / (2 * c.distances[1]) if c.distances[1] > 0 else inf,
            behind=behind,
            gap=gap,
        )


def _actions(given: SafetyInput) -> Iterator[ActionOutlook]:
    scene, forecast = given.scene, given.forecast
    plain = [a if a in LONGITUDINAL else Action.IDLE for a in given.actions]
    plans = [(action, Action.IDLE) for action in plain]
    keeps = forecast.travel(scene.ego.speed, scene.intent.target_speed, plans, scene.where)
    for k, action in enumerate(given.actions):
        behind = _follower(given, action)
        yield ActionOutlook(
            action=action,
            arrivals=tuple(forecast.time_to(c.distances[0], keeps[k]) for c in given.conflicts),
            stops=tuple(bool(given.stops[k][-1] - scene.place < c.distances[0]) for c in given.conflicts),
            follower="" if behind is None else behind.id,
            braking=0.0 if behind is None else forced_braking(given, behind, given.goes[k]),
        )


def _follower(given: SafetyInput, action: Action) -> TrackedVehicle | None:
    """Return the vehicle behind on the lane on which a CAV drives after an action, with its gap there."""
    scene = given.scene
    if action not in SIDES:
        return scene.next_in(Role.REARING)
    index = scene.ego.lane[2] + SIDES[action]
    for b in scene.beside:
        n = scene.neighbour(b.id)
        if b.lane[2] == index and b.role is Role.REARING and n is not None:
            return replace(n, gap=b.gap)
    return None


def _passage(given: SafetyInput, c: Conflict) -> ExpectedPassage:
    zone = given.road_map.zones(*c.routes)[c.zone]
    out = zone.exit_j if zone.merge_j is None else zone.merge_j + LENGTH
    human = not given.vehicles[c.other].is_cav
    for motion in given.expected.get(c.other, ()):
        if motion.route == c.routes[1]:
            return ExpectedPassage(*(_time_at(given, motion.places, s, human) for s in (zone.entry_j, out)))
    return ExpectedPassage(inf, inf)


def _time_at(given: SafetyInput, places: NDArray[np.float64], s: float, human: bool) -> float:
    """Return when a vehicle is at an arc length [s]; past the horizon only of human drivers, who keep their speed."""
    times = given.forecast.times
    there = places >= s
    if there.any():
        return float(times[int(np.argmax(there))])
    speed = float(places[-1] - places[-2]) / float(times[-1] - times[-2])
    return float(times[-1]) + (s - float(places[-1])) / speed if human and speed >= STANDS else inf


def _leader(given: SafetyInput, n: TrackedVehicle) -> tuple[str, float]:
    """Return the vehicle that another one follows, and the free distance between them [m]."""
    road_map, nearest = given.road_map, (FOLLOWS, "")
    for other in given.vehicles.values():
        gap = max(hypot(other.x - n.x, other.y - n.y) - (other.length + n.length) / 2, 0.0)
        if other.id == n.id or gap >= nearest[0]:
            continue
        ways = ((route, place, way, there) for route, place in n.routes for way, there in other.routes)
        if any(
            is_behind(zone, place, there) for route, place, way, there in ways for zone in road_map.zones(route, way)
        ):
            nearest = gap, other.id
    return nearest[1], nearest[0]


def _first_by_rule(given: SafetyInput, c: Conflict) -> str:
    """Return whom the rules of the road let go first; nothing where they do not say."""
    road_map = given.road_map
    ends = [road_map.changes.ahead(c.routes[k], c.places[k]) is not None for k in (0, 1)]
    if ends[0] is not ends[1]:
        return "it" if ends[0] else "you"
    if not road_map.road.regulated:
        return ""
    mine, its = (road_map.lanes[road_map.lane_at(c.routes[k], c.places[k])].priority for k in (0, 1))
    return "" if mine == its else "you" if mine > its else "it"


def _norms(given: SafetyInput) -> Iterator[str]:
    """Give the rules of the road that apply here and now."""
    scene, road_map = given.scene, given.road_map
    full = full_exit(given.moment, given.vehicles, given.vehicles[given.ego])
    if full is not None:
        yield f"{full[0]} leaves no room past the junction: do not enter what you cannot leave"
    if scene.must_change is None and any(
        road_map.changes.ahead(c.routes[1], c.places[1]) is not None for c in given.conflicts
    ):
        yield "a lane ends beside yours: let one vehicle from it in front of you where that costs you little"
    if scene.ego.speed < STANDS:
        stands = {n.id for n in scene.neighbours if n.speed < STANDS}
        for c in given.conflicts:
            first = _first_by_rule(given, c) if c.other in stands else ""
            if first:
                who = "you have" if first == "you" else f"{c.other} has"
                yield f"you and {c.other} both stand: {who} the right of way"
                return
