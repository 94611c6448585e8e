"""All three layers together: which actions stay, and why the others were removed."""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes.action import Action
from codriving.datatypes.situation import ActionAssessment
from codriving.reasoning.prediction.clearance import first_overlap
from codriving.reasoning.prediction.expectation import (
    CLEARS,
    binding_zones,
    is_behind,
    keeps_order,
    progress_by_action,
    worth,
)
from codriving.reasoning.prediction.plans import PLANS
from codriving.reasoning.safety.adjacent_lane import check_adjacent
from codriving.reasoning.safety.beside import beside
from codriving.reasoning.safety.conflict_lane import check_conflicts
from codriving.reasoning.safety.outlook import LONGITUDINAL, Outlook
from codriving.reasoning.safety.same_lane import check_ahead, check_behind

Array = NDArray[np.float64]


class SafetyCheck(Protocol):
    """Assesses every available action of one CAV."""

    def assess(self, outlook: Outlook) -> tuple[ActionAssessment, ...]:
        """Return one assessment an action, in the order of the actions."""
        ...


class NoCheck:
    """Without the safety check every action stays."""

    def assess(self, outlook: Outlook) -> tuple[ActionAssessment, ...]:
        """Return every action as safe."""
        return tuple(
            ActionAssessment(action, True, (), arrivals(outlook, k), progress(outlook, action))
            for k, action in enumerate(outlook.actions)
        )


class ThreeLayers:
    """Same lane, adjacent lane, conflict lane."""

    def assess(self, outlook: Outlook) -> tuple[ActionAssessment, ...]:
        """Remove what is unsafe; if nothing is left, keep what is least dangerous and say so.

        Braking hard in front of somebody is only removed while a faster action is safe.
        """
        reasons: dict[Action, list[str]] = {action: [] for action in outlook.actions}
        for layer in (check_ahead, check_adjacent, check_conflicts):
            for action, why in layer(outlook).items():
                # Lane changes are judged by the second layer, as if the CAV were on the other lane already.
                if layer is check_adjacent or action in LONGITUDINAL:
                    reasons[action] += why
        abrupt = check_behind(outlook)
        if any(not why and action not in abrupt for action, why in reasons.items()):
            for action, why in abrupt.items():
                reasons[action] += why
        forced = None if any(not why for why in reasons.values()) else least_dangerous(outlook)
        if forced is not None:
            reasons[forced].append("no action is safe; this one is the least dangerous")
        return tuple(
            ActionAssessment(
                action,
                not reasons[action] or action is forced,
                tuple(reasons[action]),
                arrivals(outlook, k),
                progress(outlook, action),
            )
            for k, action in enumerate(outlook.actions)
        )


def arrivals(outlook: Outlook, k: int) -> tuple[float, ...]:
    """Return when each conflict zone is reached at the earliest after an action.

    Returns:
        Time from now, one a conflict [s].
    """
    travelled = outlook.goes[k] - outlook.scene.place
    return tuple(outlook.forecast.time_to(c.distances[0], travelled) for c in outlook.conflicts)


def progress(outlook: Outlook, action: Action) -> float | None:
    """Return how far the CAV gets within the horizon if it begins with an action and then keeps the order.

    Returns:
        Distance [m]; None if the order cannot be kept then.
    """
    if action in LONGITUDINAL:
        return outlook.expected[outlook.scene.ego.id][0].progress.get(action)
    there = beside(outlook, action)
    if there is None:
        return None
    ego, forecast = outlook.scene.ego, outlook.forecast
    travels = forecast.travel(ego.speed, outlook.scene.intent.target_speed, PLANS)
    keeps = np.ones(len(PLANS), dtype=np.bool_)
    for k, (route, place) in enumerate(there.others[ego.id].routes):
        motion = place + travels[:, : forecast.steps + 1 if k == 0 else round(CLEARS / forecast.sample) + 1]
        keeps &= keeps_order(
            ego.id,
            route,
            motion,
            there.others,
            there.expected,
            there.order,
            there.road_map,
            there.lag,
            forecast.sample,
            there.minds_conflicts and k == 0,
        )
    return progress_by_action(np.where(keeps, worth(travels), -np.inf)).get(Action.IDLE)


def least_dangerous(outlook: Outlook) -> Action:
    """Return the action after which an overlap with anybody lies farthest ahead, braking or going on.

    Others are taken to keep their speed, to brake hard and to accelerate hard; whoever drives ahead may always brake.
    """
    best: tuple[int, int, Action] | None = None
    preferred = {Action.SLOWER: 2, Action.IDLE: 1}
    motions = np.concatenate((outlook.stops, outlook.goes))
    soonest = sum(_soonest(outlook, motions, n).reshape(2, -1).max(axis=0) for n in range(3))
    for action, margin in zip(outlook.actions, np.asarray(soonest).tolist(), strict=True):
        key = (margin, preferred.get(action, 0), action)
        if best is None or key[:2] > best[:2]:
            best = key
    assert best is not None  # there is always at least IDLE
    return best[2]


def _soonest(outlook: Outlook, motions: Array, guess: int) -> NDArray[np.int64]:
    """Return the step at which each motion first overlaps with anybody's, for one of three guesses of what they do."""
    scene = outlook.scene
    soonest: NDArray[np.int64] = np.full(len(motions), motions.shape[1])
    for name, expected in outlook.expected.items():
        if name == scene.ego.id:
            continue
        other = outlook.others[name]
        reach = outlook.forecast.reach(other.speed, other.is_cav)
        travel = (reach.steady, reach.least, reach.most)[guess]
        for e in expected:
            now = float(e.places[0])
            zones = outlook.road_map.zones(scene.intent.route, e.route)
            # Whoever drives behind on the same lane has to mind the CAV, not the other way round.
            for zone in binding_zones(zones, scene.place, now, True):
                ahead = is_behind(zone, scene.place, now)
                steps = first_overlap(zone, motions, now + (reach.least if ahead else travel))
                soonest = np.minimum(soonest, steps)
    return soonest
