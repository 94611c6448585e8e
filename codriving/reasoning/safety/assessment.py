"""All three layers together: which actions stay, and why the others were removed."""

from abc import ABC, abstractmethod
from collections.abc import Collection, Mapping, Sequence

import numpy as np

from codriving.datatypes import Action, ActionAssessment
from codriving.geometry import Array, Steps, first_overlap
from codriving.reasoning.conflicts import is_behind, is_open
from codriving.reasoning.prediction.expectation import plans_that_keep, progress_by_action, valued
from codriving.reasoning.prediction.rollout import plan_library
from codriving.reasoning.safety.adjacent_lane import check_adjacent
from codriving.reasoning.safety.conflict_lane import check_conflicts, check_exit
from codriving.reasoning.safety.safety_input import LONGITUDINAL, SafetyInput
from codriving.reasoning.safety.same_lane import check_ahead, check_behind


class SafetyCheck(ABC):
    """Assesses every available action of one CAV."""

    @abstractmethod
    def assess(self, given: SafetyInput) -> tuple[ActionAssessment, ...]:
        """Return one assessment an action, in the order of the actions."""


class NoCheck(SafetyCheck):
    """Without the safety check every action stays."""

    def assess(self, given: SafetyInput) -> tuple[ActionAssessment, ...]:
        """Return every action as safe."""
        return _assessments(given, dict.fromkeys(given.actions, ()))


class ThreeLayers(SafetyCheck):
    """Same lane, adjacent lane, conflict lane."""

    def assess(self, given: SafetyInput) -> tuple[ActionAssessment, ...]:
        """Remove what is unsafe; if nothing is left, keep what is least dangerous and say so.

        Braking hard in front of a vehicle is only removed while a faster action is safe.
        """
        reasons: dict[Action, list[str]] = {action: [] for action in given.actions}
        for layer in (check_ahead, check_adjacent, check_conflicts, check_exit):
            for action, why in layer(given).items():
                # Lane changes are judged by the second layer, as if the CAV were on the other lane already.
                if layer is check_adjacent or action in LONGITUDINAL:
                    reasons[action] += why
        abrupt = check_behind(given)
        if any(not why and action not in abrupt for action, why in reasons.items()):
            for action, why in abrupt.items():
                reasons[action] += why
        forced = None if any(not why for why in reasons.values()) else least_dangerous(given)
        if forced is not None:
            reasons[forced].append("no action is safe; this one is the least dangerous")
        return _assessments(given, reasons, forced)


def _assessments(
    given: SafetyInput, reasons: Mapping[Action, Sequence[str]], forced: Action | None = None
) -> tuple[ActionAssessment, ...]:
    scene, model = given.scene, given.forecast.model
    return tuple(
        ActionAssessment(
            action,
            not why or action is forced,
            tuple(why),
            arrivals(given, k),
            progress(given, action),
            model.target_after(action, scene.ego.speed, scene.intent.target_speed),
        )
        for k, (action, why) in enumerate(reasons.items())
    )


def arrivals(given: SafetyInput, k: int) -> tuple[float, ...]:
    """Return when each conflict zone is reached at the earliest after an action."""
    return given.forecast.times_to([c.distances[0] for c in given.conflicts], given.goes[k] - given.scene.place)


def progress(given: SafetyInput, action: Action) -> float | None:
    """Return how far the CAV gets within the horizon if it begins with an action and then keeps the order."""
    if action in LONGITUDINAL:
        return given.expected[given.scene.ego.id][0].progress.get(action)
    there = given.beside(action)
    if there is None:
        return None
    travels, keeps = plans_that_keep(
        there.moment, there.ego, there.vehicles[there.ego], there.expected, there.order, there.lag
    )
    gained = np.where(keeps, valued(there.moment, there.vehicles[there.ego], travels), -np.inf)
    return progress_by_action(gained, plan_library(there.forecast.model)).get(Action.IDLE)


def least_dangerous(given: SafetyInput, among: Collection[Action] | None = None) -> Action:
    """Return the action after which an overlap with any vehicle lies farthest ahead, braking or going on.

    Others are taken to keep their speed, to brake hard and to accelerate hard; the vehicle ahead may always brake.
    """
    preferred = {Action.SLOWER: 2, Action.IDLE: 1}
    motions = np.concatenate((given.stops, given.goes))
    soonest = sum(_soonest(given, motions, n).reshape(2, -1).max(axis=0) for n in range(3))
    margins: dict[Action, int] = dict(zip(given.actions, np.asarray(soonest).tolist(), strict=True))
    return max(
        given.actions if among is None else among, key=lambda action: (margins[action], preferred.get(action, 0))
    )


def _soonest(given: SafetyInput, motions: Array, guess: int) -> Steps:
    """Return the step at which each motion first overlaps with that of another vehicle, for one of three guesses."""
    scene = given.scene
    soonest: Steps = np.full(len(motions), motions.shape[1])
    for name, expected in given.expected.items():
        if name == scene.ego.id:
            continue
        other = given.vehicles[name]
        for k, e in enumerate(expected):
            now = float(e.places[0])
            reach = given.forecast.reach_of(other, other.routes[0 if other.is_cav else k])
            travel = (reach.steady, reach.least, reach.most)[guess]
            # A vehicle behind on the same lane has to mind the CAV, not the other way round.
            for zone in given.road_map.zones(scene.intent.route, e.route):
                ahead = is_behind(zone, scene.place, now)
                if ahead or is_open(zone, scene.place, now):
                    steps = first_overlap(zone, motions, now + (reach.least if ahead else travel))
                    soonest = np.minimum(soonest, steps)
    return soonest
