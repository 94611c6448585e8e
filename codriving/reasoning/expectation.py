"""How everybody is expected to move if the passing order is kept: planned one after another, first to last."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes.action import Action
from codriving.datatypes.conflict import Relation
from codriving.datatypes.order import PassingOrder
from codriving.geometry.road_map import RoadMap
from codriving.geometry.zone import ConflictZone
from codriving.prediction.forecast import Forecast
from codriving.reasoning.clearance import stays_behind
from codriving.reasoning.conflicts import is_open
from codriving.reasoning.movers import Mover
from codriving.reasoning.plans import PLANS, STARTS_WITH

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Expected:
    """The expected motion of one vehicle.

    Attributes:
        route: Route that it is expected on.
        places: Arc length over time (n,) [m].
        free: Whether it is expected to go at once, held up by nobody.
        progress: How far it gets within the horizon if it begins with an action and keeps the order [m]; no entry for
            an action with which it could not keep the order, and none at all for human drivers.
    """

    route: str
    places: Array
    free: bool
    progress: Mapping[Action, float]


def expect(
    vehicles: dict[str, Mover],
    order: PassingOrder,
    road_map: RoadMap,
    forecast: Forecast,
    lag: int,
    minds_conflicts: bool,
) -> dict[str, tuple[Expected, ...]]:
    """Plan every vehicle in the passing order against those before it.

    Human drivers are expected to keep their speed on each route that they may take.

    Args:
        vehicles: The vehicles that are known, by id.
        order: Who goes first.
        road_map: The precomputed road.
        forecast: Predictions of this step.
        lag: Steps that must lie between one vehicle's leaving a zone and the next one's entering it.
        minds_conflicts: Whether conflicts are known at all; otherwise everybody only minds who drives ahead.

    Returns:
        Expected motions by id: one for a CAV, one a possible route for others.
    """
    cavs = [v for v in vehicles.values() if v.is_cav]
    found: dict[str, tuple[Expected, ...]] = {}
    for v in vehicles.values():
        if not v.is_cav:
            steady = forecast.reach(v.speed, False).steady
            found[v.id] = tuple(Expected(route, place + steady, True, {}) for route, place in v.routes)
    rank = {name: i for i, name in enumerate(order.sequence)}
    # Whoever is in no conflict follows the order of the lanes: the vehicle farther along its route first.
    for v in sorted(cavs, key=lambda v: (rank.get(v.id, len(rank)), -v.routes[0][1], v.id)):
        route, place = v.routes[0]
        places = place + forecast.travel(v.speed, v.target, PLANS)
        keeps = np.ones(len(PLANS), dtype=np.bool_)
        for other in found:
            # A driver who may still take several routes is left to the safety check: no slowing down early for guesses.
            if order.first_of(v.id, other) == v.id or len(vehicles[other].routes) > 1:
                continue
            now = dict(vehicles[other].routes)
            for motion in found[other]:
                for zone in binding_zones(
                    road_map.zones(route, motion.route), place, now[motion.route], minds_conflicts
                ):
                    keeps &= stays_behind(zone, places, motion.places, lag, 0.0)
        gained = np.where(keeps, places[:, -1] - place, -np.inf)
        best = int(np.argmax(gained)) if keeps.any() else len(PLANS) - 1
        progress = {
            first: float(max(gained[list(plans)])) for first, plans in STARTS_WITH.items() if keeps[list(plans)].any()
        }
        found[v.id] = (Expected(route, places[best], best == 0, progress),)
    return found


def binding_zones(
    zones: Sequence[ConflictZone], place: float, other: float, minds_conflicts: bool
) -> list[ConflictZone]:
    """Select the zones in which a vehicle has to mind another one that goes before it.

    Args:
        zones: Zones of the two routes, seen from the vehicle.
        place: Arc length of the vehicle [m].
        other: Arc length of the one that goes before it [m].
        minds_conflicts: Whether zones count in which it is open who goes first.
    """
    return [z for z in zones if (minds_conflicts and is_open(z, place, other)) or is_behind(z, place, other)]


def is_behind(zone: ConflictZone, place: float, other: float) -> bool:
    """Whether a vehicle follows another one in a stretch that both routes share.

    Args:
        zone: The zone, seen from the vehicle.
        place: Arc length of the vehicle [m].
        other: Arc length of the other vehicle [m].
    """
    if place > zone.exit_i or other > zone.exit_j:
        return False
    if zone.relation in (Relation.FOLLOWING, Relation.DIVERGING):
        return place < other
    if zone.merge_i is None or zone.merge_j is None or is_open(zone, place, other):
        return False
    return place - zone.merge_i < other - zone.merge_j
