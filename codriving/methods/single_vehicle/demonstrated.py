"""The pattern of DiLu's demonstrations as a rule: FASTER, then IDLE, then SLOWER, and the first that is acceptable."""

from codriving.datatypes.action import Action
from codriving.datatypes.order import Precedence
from codriving.errors import ConfigError
from codriving.methods.single_vehicle.acceptance import Limits, change_refused, refusals
from codriving.methods.single_vehicle.encounters import Encounter, encounters
from codriving.methods.single_vehicle.expected_first import goes_first
from codriving.methods.single_vehicle.lane_choice import LaneChoice, Side
from codriving.methods.single_vehicle.patience import Patience
from codriving.methods.single_vehicle.protocol import Choice, Driver, View
from codriving.methods.single_vehicle.starting import may_start
from codriving.reasoning.prediction.idm import IntelligentDriver
from codriving.reasoning.prediction.rollout import Plan

PREFERRED = (Action.FASTER, Action.IDLE, Action.SLOWER)
"""Actions along the lane, the most wanted first."""

CONSTANT: tuple[Plan, ...] = tuple((action,) for action in PREFERRED)
"""Each of them, taken again and again; a forecast has to know these plans."""

LIMITS = {
    "horizon": (0.5, 10.0),
    "headway": (0.0, 5.0),
    "merging": (0.0, 5.0),
    "gap": (0.0, 20.0),
    "stop_gap": (0.0, 20.0),
    "after": (0.0, 5.0),
    "tie": (0.0, 5.0),
    "firm": (0.5, 10.0),
    "patience": (0.0, 60.0),
    "clear": (0.0, 10.0),
}
"""Least and largest value of each setting."""


class Demonstrated(Driver):
    """A driver that takes the first acceptable action (after the reasoning shown in Wen et al., 2024).

    Args:
        horizon: Time over which an action is predicted, taken again and again [s].
        headway: Time gap that is kept to whoever drives ahead [s].
        merging: The same on the other lane for a change that the route asks for [s].
        gap: Distance that is kept to whoever drives ahead, however slow [m].
        stop_gap: Distance from a zone at which the vehicle waits [m].
        after: Time between the other one's leaving a zone and the vehicle's entering it [s].
        tie: Difference of the times to a zone up to which both count as there at once [s].
        firm: Braking beyond which nobody is expected to wait any more [m/s2].
        patience: Time after which a waiting vehicle may start into an empty zone [s].
        clear: Time that whoever moves towards that zone must be away from it beyond what the start takes [s].

    Raises:
        ConfigError: If a setting is out of range.
    """

    name = "demonstrated"
    variant = ""

    def __init__(
        self,
        horizon: float,
        headway: float,
        merging: float,
        gap: float,
        stop_gap: float,
        after: float,
        tie: float,
        firm: float,
        patience: float,
        clear: float,
        lanes: LaneChoice,
    ) -> None:
        given = {key: value for key, value in locals().items() if key in LIMITS}
        for key, value in given.items():
            low, high = LIMITS[key]
            if not low <= value <= high:
                raise ConfigError(f"{key} must be {low:g} to {high:g}, got {value:g}")
        self.limits = Limits(horizon, headway, gap, stop_gap, after)
        self.merging, self.tie, self.firm = merging, tie, firm
        self.patience, self.clear, self.lanes = patience, clear, lanes
        self._idm = IntelligentDriver(gap=gap)
        self._patience = Patience()

    def reset(self) -> None:
        """Begin an episode; nothing is remembered from the one before."""
        self._patience = Patience()
        self.lanes.reset()

    def decide(self, view: View) -> Choice:
        """Change lanes if that is wanted and safe, or take the first action along the lane that is acceptable.

        Args:
            view: What the CAV sees; its forecast has to know the plans of ``CONSTANT``.
        """
        ego = view.scene.ego
        waited = self._patience.waited(ego.id, ego.speed, view.time)
        change, refused = self.lanes.choose(view, self._idm, self.refuses)
        if change is not None:
            return Choice(change.action, change.reason, (), refused)
        met = encounters(view, float(view.forecast.reach(ego.speed, True).least[-1]), self.firm)
        creeps = may_start(view, met, waited, self.patience, self.clear)
        # Whoever has waited long enough lets nobody in an empty zone go first any more.
        before, precedences = self.first(view, () if creeps else met)
        refused = {**refused, **refusals(view, before, self.limits, PREFERRED)}
        counts = {"creeps": int(creeps)}
        action = next((a for a in PREFERRED if a in view.actions and a not in refused), None)
        if action is None:
            why = refused.pop(Action.SLOWER, "")
            return Choice(Action.SLOWER, f"nothing is acceptable, so SLOWER: {why}", precedences, refused, counts)
        return Choice(action, _reason(action, refused, waited if creeps else 0.0), precedences, refused, counts)

    def refuses(self, view: View, side: Side, idm: IntelligentDriver) -> str:
        """Say why a lane change is refused; nothing if it is not."""
        must = view.scene.must_change is not None
        headway = self.merging if must else self.limits.headway
        return self.lanes.braked_for(view, side, idm) or change_refused(view, side, self.limits, headway)

    def first(self, view: View, met: tuple[Encounter, ...]) -> tuple[tuple[Encounter, ...], tuple[Precedence, ...]]:
        """Return the encounters in which the other one may be there first, and who goes first by that."""
        ego = view.scene.ego.id
        before, precedences = [], dict[str, Precedence]()
        for e in met:
            own, why = goes_first(e, view.road_map, self.tie)
            other = e.conflict.other
            if own:
                precedences.setdefault(other, Precedence(ego, other, why))
                continue
            before.append(e)
            if other not in precedences or precedences[other].first == ego:
                precedences[other] = Precedence(other, ego, why)
        return tuple(before), tuple(precedences.values())


def _reason(action: Action, refused: dict[Action, str], waited: float) -> str:
    if waited:
        return f"it has waited for {waited:.0f} s and the zones ahead are empty, so {action}"
    if action is Action.FASTER:
        return "accelerating keeps clear of everybody"
    faster = PREFERRED[PREFERRED.index(action) - 1]
    return f"{action}, since with {faster} {refused[faster]}" if faster in refused else f"{action} keeps clear"
