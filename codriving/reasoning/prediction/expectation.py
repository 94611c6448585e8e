"""How all vehicles are expected to move if the passing order is kept: planned one after another, first to last."""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from codriving.datatypes import Action, PassingOrder, TrackedVehicle
from codriving.geometry import Array, ConflictZone, Flags, halts_behind, stays_ahead, stays_behind
from codriving.reasoning.conflicts import has_joined, is_behind, is_open
from codriving.reasoning.exits import full_exit
from codriving.reasoning.perception import Moment
from codriving.reasoning.prediction.reversals import price
from codriving.reasoning.prediction.rollout import Plan, plan_library, starts_with

# Time gap to the vehicle ahead that is planned for [s]; the safety check alone would allow less or ask for more.
HEADWAY = 0.8

# What a motion has to stay behind: the zone in which both meet, the places of the other one, the lag in samples, the
# time between two samples if it must be able to stop there, too [s], and whether it may as well be past before.
Bound = tuple[ConflictZone, Array, int, float, bool]

EARLY = 0.3  # Weight of the mean distance within the horizon against the distance at its end


@dataclass(frozen=True, slots=True)
class Expected:
    """The expected motion of one vehicle."""

    route: str
    places: Array  # Arc length over time (n,) [m]
    free: bool
    # How far it gets within the horizon if it begins with an action and keeps the order [m]; no entry for an action
    # with which it could not keep the order, and none at all for human drivers.
    progress: Mapping[Action, float]


def expect_all(
    moment: Moment, orders: Mapping[str, PassingOrder], lag: int
) -> dict[str, dict[str, tuple[Expected, ...]]]:
    """Expect what follows from each CAV's knowledge and order; CAVs that agree in both share one expectation.

    Args:
        orders: The order that each CAV goes by, by id.
        lag: Samples that should lie between one vehicle's leaving a zone and the next one's entering it.
    """
    done: dict[tuple[object, ...], dict[str, tuple[Expected, ...]]] = {}
    found = {}
    for ego, order in orders.items():
        key = (id(order), *((v.id, v.is_cav, v.speed, v.target, v.routes) for v in moment.vehicles[ego].values()))
        if key not in done:
            done[key] = expect(moment, ego, order, lag)
        found[ego] = done[key]
    return found


def expect_human(moment: Moment, human: TrackedVehicle) -> tuple[Expected, ...]:
    """Expect a human driver to keep its speed on each route that it may take."""
    reach = moment.forecast.reach
    return tuple(Expected(way[0], way[1] + reach(human.speed, False, way).steady, True, {}) for way in human.routes)


def expect(moment: Moment, ego: str, order: PassingOrder, lag: int) -> dict[str, tuple[Expected, ...]]:
    """Plan every vehicle that one CAV knows of in the passing order against those before it, and leaders first.

    Human drivers are expected to keep their speed on each route that they may take.
    """
    vehicles = moment.vehicles[ego]
    found = {v.id: expect_human(moment, v) for v in vehicles.values() if not v.is_cav}
    cavs = {v.id: v for v in vehicles.values() if v.is_cav}
    for v in (cavs[name] for name in planning_order(order.sequence, cavs, _ahead(moment, cavs.values()))):
        travels, keeps = plans_that_keep(moment, ego, v, found, order, lag)
        gained = np.where(keeps, valued(moment, v, travels), -np.inf)
        best = int(np.argmax(gained)) if keeps.any() else len(travels) - 1
        gains = with_guesses(moment, ego, v, travels, gained, found, order, lag)
        found[v.id] = tuple(
            Expected(route, place + travels[best], best == 0, gains if k == 0 else {})
            for k, (route, place) in enumerate(v.routes)
        )
    return found


def with_guesses(
    moment: Moment,
    ego: str,
    vehicle: TrackedVehicle,
    travels: Array,
    gained: Array,
    expected: Mapping[str, tuple[Expected, ...]],
    order: PassingOrder,
    lag: int,
) -> dict[Action, float]:
    """Return how far a vehicle gets after each action if each route that a human driver may take is as likely.

    Of several such drivers the one counts that holds the vehicle up most. On a route on which no plan keeps the order
    the vehicle has to stop, which the safety check sees to.
    """
    plans = plan_library(moment.forecast.model)
    gains = unhindered = progress_by_action(gained, plans)
    if not moment.sees_conflicts:
        return gains
    (route, place), stops = vehicle.routes[0], dict[Action, float]()
    for other, motions in expected.items():
        if moment.vehicles[ego][other].is_cav or len(motions) < 2:
            continue
        each = []
        for motion in motions:
            bounds = list(bounds_of(moment, ego, vehicle.id, route, place, {other: (motion,)}, order, lag, True))
            if not bounds:
                each.append(unhindered)
                continue
            stops = stops or progress_by_action(-worth(travels), plans)
            keeps = _keeps(place + travels, bounds)
            each.append(progress_by_action(np.where(keeps, gained, -np.inf), plans))
        gains = {
            action: min(gain, sum(way[action] if action in way else -stops[action] for way in each) / len(each))
            for action, gain in gains.items()
        }
    return gains


def _ahead(moment: Moment, cavs: Collection[TrackedVehicle]) -> set[tuple[str, str]]:
    """Return the pairs of CAVs, one that drives ahead on a way of the other one and that one."""
    return {
        (ahead.id, behind.id)
        for behind in cavs
        for ahead in cavs
        if ahead.id != behind.id
        for route, place in behind.routes
        for way, there in ahead.routes
        if any(is_behind(zone, place, there) for zone in moment.road_map.zones(route, way))
    }


def planning_order(
    sequence: Sequence[str], vehicles: Mapping[str, TrackedVehicle], ahead: set[tuple[str, str]]
) -> list[str]:
    """Line all CAVs up for planning: in sequence, those in no conflict by how far along they are, leaders first.

    Args:
        ahead: Pairs of CAVs, one that drives ahead and one that follows.
    """
    rank = {name: i for i, name in enumerate(sequence)}
    leaders: dict[str, list[str]] = {}
    for leader, follower in sorted(ahead):
        leaders.setdefault(follower, []).append(leader)
    order: list[str] = []
    entered: set[str] = set()

    def place(name: str) -> None:
        # Vehicles ahead are drawn forward; a circle, as only an overlap makes one, is cut where it closes.
        if name not in entered:
            entered.add(name)
            for leader in leaders.get(name, ()):
                place(leader)
            order.append(name)

    for name in sorted(vehicles, key=lambda n: (rank.get(n, len(rank)), -vehicles[n].routes[0][1], n)):
        place(name)
    return order


def plans_that_keep(
    moment: Moment,
    ego: str,
    vehicle: TrackedVehicle,
    expected: Mapping[str, tuple[Expected, ...]],
    order: PassingOrder,
    lag: int,
) -> tuple[Array, Flags]:
    """Return how far each plan takes a vehicle (plans, n) [m], and whether it keeps the order on each of its routes.

    Before an exit that is full a plan has to stop.
    """
    forecast = moment.forecast
    travels = forecast.travel(vehicle.speed, vehicle.target, plan_library(forecast.model), vehicle.routes[0])
    keeps = np.ones(len(travels), dtype=np.bool_)
    for k, (route, place) in enumerate(vehicle.routes):
        # A lane that the vehicle is leaving is minded until its body is off it.
        until = forecast.steps + 1 if k == 0 else forecast.clears
        minds = moment.sees_conflicts and k == 0
        keeps &= keeps_order(moment, ego, vehicle.id, route, place + travels[:, :until], expected, order, lag, minds)
    full = full_exit(moment, moment.vehicles[ego], vehicle)
    if full is not None:
        keeps &= vehicle.routes[0][1] + travels[:, -1] < full[1]
    return travels, keeps


def keeps_order(
    moment: Moment,
    ego: str,
    name: str,
    route: str,
    places: Array,
    expected: Mapping[str, tuple[Expected, ...]],
    order: PassingOrder,
    lag: int,
    minds_conflicts: bool,
) -> Flags:
    """Whether a vehicle that one CAV knows of stays behind all vehicles that drive ahead or go first."""
    place = float(places[0, 0])
    return _keeps(places, bounds_of(moment, ego, name, route, place, expected, order, lag, minds_conflicts))


def _keeps(places: Array, bounds: Iterable[Bound]) -> Flags:
    """Whether motions stay behind others."""
    keeps: Flags = np.ones(len(places), dtype=np.bool_)
    farthest: Array | None = None
    for zone, other, after, halts, leads in bounds:
        farthest = places.max(axis=0) if farthest is None else farthest
        behind = stays_behind(zone, places, other[: places.shape[1]], after, 0.0, farthest)
        if leads and not behind.all():
            behind |= stays_ahead(zone, places, other[: places.shape[1]], after, 0.0)
        keeps &= behind
        if halts:
            keeps &= halts_behind(zone, places, other[: places.shape[1]], halts)
    return keeps


def bounds_of(
    moment: Moment,
    ego: str,
    name: str,
    route: str,
    place: float,
    expected: Mapping[str, tuple[Expected, ...]],
    order: PassingOrder,
    lag: int,
    minds_conflicts: bool,
) -> Iterator[Bound]:
    """Say behind what a vehicle has to stay on a route of its own."""
    forecast = moment.forecast
    vehicles = moment.vehicles[ego]
    for other, motions in expected.items():
        if other == name:
            continue
        # No CAV slows down early for a driver who may still take several routes; see `with_guesses`.
        certain = vehicles[other].is_cav or len(motions) == 1
        minds = minds_conflicts and certain and order.first_of(name, other) != name
        for motion in motions:
            there = float(motion.places[0])
            for zone in moment.road_map.zones(route, motion.route):
                following = is_behind(zone, place, there)
                if following or (minds and is_open(zone, place, there)):
                    keeps_lane = following and has_joined(zone, place)
                    after = min(lag, round(HEADWAY / forecast.sample)) if keeps_lane else lag
                    halts = forecast.sample if following and forecast.model.steady else 0.0
                    leads = moment.by_zone and not following and vehicles[other].is_cav
                    yield zone, motion.places, after, halts, leads


def valued(moment: Moment, vehicle: TrackedVehicle, travels: Array) -> Array:
    """Return what each plan of the library is worth to a vehicle, its reversals counted [m]."""
    forecast = moment.forecast
    model, state = forecast.model, forecast.state(vehicle.speed, vehicle.target, vehicle.routes[0])
    if state not in forecast.values:
        gained = worth(travels)
        prices = price(vehicle.speed, vehicle.target, plan_library(model)) if model.steady else 0.0
        forecast.values[state] = gained - prices
    return forecast.values[state]


def worth(travels: Array) -> Array:
    """Return what a plan is worth: the distance at the end of the horizon, and a little of being closer before.

    Without the second part a vehicle that has to wait beyond the horizon would put off its approach for ever.
    """
    return np.asarray((1 - EARLY) * travels[:, -1] + EARLY * travels.mean(axis=1))


def progress_by_action(gained: Array, plans: tuple[Plan, ...]) -> dict[Action, float]:
    """Return how far a vehicle gets at best after each action."""
    firsts, beginnings = _beginnings(plans)
    best = np.maximum.reduceat(gained, beginnings).tolist()
    return {action: gain for action, gain in zip(firsts, best, strict=True) if gain > -np.inf}


@lru_cache(maxsize=8)
def _beginnings(plans: tuple[Plan, ...]) -> tuple[tuple[Action, ...], list[int]]:
    """Return the actions with which plans begin, in their order, and the first plan of each."""
    found = starts_with(plans)
    return tuple(found), [which[0] for which in found.values()]
