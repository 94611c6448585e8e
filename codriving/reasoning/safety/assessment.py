"""All three layers together: which actions stay, and why the others were removed."""

from typing import Protocol

from codriving.datatypes.action import Action
from codriving.datatypes.situation import ActionAssessment
from codriving.reasoning.clearance import first_overlap
from codriving.reasoning.safety.adjacent_lane import check_adjacent
from codriving.reasoning.safety.conflict_lane import check_conflicts
from codriving.reasoning.safety.outlook import LONGITUDINAL, Outlook
from codriving.reasoning.safety.same_lane import check_ahead, check_behind


class SafetyCheck(Protocol):
    """Assesses every available action of one CAV."""

    def assess(self, outlook: Outlook) -> tuple[ActionAssessment, ...]:
        """Return one assessment an action, in the order of the actions.

        Args:
            outlook: The CAV's view.
        """
        ...


class NoCheck:
    """Without the safety check every action stays."""

    def assess(self, outlook: Outlook) -> tuple[ActionAssessment, ...]:
        """Return every action as safe.

        Args:
            outlook: The CAV's view.
        """
        return tuple(
            ActionAssessment(action, True, (), arrivals(outlook, k), progress(outlook, action))
            for k, action in enumerate(outlook.actions)
        )


class ThreeLayers:
    """Same lane, adjacent lane, conflict lane."""

    def assess(self, outlook: Outlook) -> tuple[ActionAssessment, ...]:
        """Remove what is unsafe; if nothing is left, keep what is least dangerous and say so.

        Braking hard in front of somebody is only removed while a faster action is safe.

        Args:
            outlook: The CAV's view.
        """
        reasons: dict[Action, list[str]] = {action: [] for action in outlook.actions}
        for layer in (check_ahead, check_adjacent, check_conflicts):
            for action, why in layer(outlook).items():
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

    Args:
        outlook: The CAV's view.
        k: Index of the action.

    Returns:
        Time from now, one a conflict [s].
    """
    travelled = outlook.goes[k] - outlook.scene.place
    return tuple(outlook.forecast.time_to(c.distances[0], travelled) for c in outlook.conflicts)


def progress(outlook: Outlook, action: Action) -> float | None:
    """Return how far the CAV gets within the horizon if it begins with an action and then keeps the order.

    Args:
        outlook: The CAV's view.
        action: The action.

    Returns:
        Distance [m]; None if the order cannot be kept then. A lane change counts as going on at the same speed.
    """
    (own,) = outlook.expected[outlook.scene.ego.id]
    return own.progress.get(action if action in LONGITUDINAL else Action.IDLE)


def least_dangerous(outlook: Outlook) -> Action:
    """Return the action after which an overlap with anybody lies farthest ahead, braking or going on.

    Args:
        outlook: The CAV's view.
    """
    best: tuple[int, int, Action] | None = None
    preferred = {Action.SLOWER: 2, Action.IDLE: 1}
    for k, action in enumerate(outlook.actions):
        margins = []
        for motion in (outlook.stops[k : k + 1], outlook.goes[k : k + 1]):
            soonest = motion.shape[1]
            for name, expected in outlook.expected.items():
                if name == outlook.scene.ego.id:
                    continue
                for e in expected:
                    now = float(e.places[0])
                    steady = now + outlook.forecast.reach(outlook.others[name].speed, False).steady
                    for zone in outlook.road_map.zones(outlook.scene.intent.route, e.route):
                        soonest = min(soonest, int(first_overlap(zone, motion, steady)[0]))
            margins.append(soonest)
        key = (max(margins), preferred.get(action, 0), action)
        if best is None or key[:2] > best[:2]:
            best = key
    assert best is not None  # there is always at least IDLE
    return best[2]
