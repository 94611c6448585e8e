"""The safety check behind any method: an action that it removes gives way to the nearest one that it allows."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from typing import Any

from codriving.datatypes import (
    Action,
    ActionAssessment,
    ActionFilter,
    Deliberation,
    DrivingModel,
    Method,
    PassingOrder,
    ReasonedDeliberation,
    Shares,
    WorldState,
    Wrapped,
)
from codriving.errors import require_range
from codriving.geometry import RoadMap
from codriving.methods import CoDriving, Ordered, perception_at
from codriving.reasoning import (
    AgreedOrder,
    CdaLevel,
    Moment,
    OwnOrders,
    RuleCoordinator,
    SafetyInput,
    ThreeLayers,
    expect_all,
    least_dangerous,
    nearest,
    safety_input,
)


class SafetyFilter(ActionFilter):
    """The three layers of ``codriving``, with what it perceives."""

    def __init__(self, cda: CdaLevel, margin: float) -> None:
        require_range("margin", margin, 0, 5, " s")
        self.cda, self.margin = cda, margin

    def around(self, method: Method) -> Method:
        return method if method.is_checked or method.hands_over else Filtered(method, self.cda, self.margin)


@dataclass(frozen=True, slots=True)
class FilteredAction:
    """What became of an action."""

    wanted: Action
    taken: Action
    assessments: tuple[ActionAssessment, ...]

    def as_dict(self) -> dict[str, Any]:
        """Return it as a part of a line of ``decisions.jsonl``."""
        removed = {str(a.action): list(a.reasons) for a in self.assessments if not a.safe}
        return {"wanted": str(self.wanted), "taken": str(self.taken), "removed": removed}


@dataclass(frozen=True, slots=True)
class FilteredDeliberation(Deliberation):
    """A decision step of a method, and what the safety check made of it."""

    inner: Deliberation
    filtered: Mapping[str, FilteredAction]
    counts: Mapping[str, float]
    transcript: tuple[dict[str, Any], ...]

    @property
    def actions(self) -> dict[str, Action]:
        return {name: action.taken for name, action in self.filtered.items()}

    def as_dict(self) -> dict[str, Any]:
        line = self.inner.as_dict()
        for entry in line.get("cavs", ()):
            if (found := self.filtered.get(entry["id"])) is None:
                continue  # Another CAV decides for that one
            entry["filter"] = found.as_dict()
            if found.taken is not found.wanted:
                why = f"{found.taken} in the place of {found.wanted}, which the safety check removed"
                entry |= {"action": str(found.taken), "reason": f"{why}; {found.wanted} since: {entry.get('reason')}"}
        return line


class Checked(Wrapped):
    """A method whose actions are checked; a subclass says what is driven instead of one that is not allowed."""

    def __init__(self, method: Method, cda: CdaLevel, margin: float) -> None:
        super().__init__(method)
        self.cda, self.margin = cda, margin
        self.variant, self.is_checked = f"{method.variant} filtered".strip(), True
        told = method.shares
        self.shares = Shares(told.states or cda.state_sharing, told.intents or cda.intent_sharing, told.orders)
        self._ordering = method if isinstance(method, Ordered | CoDriving) and method.orders else None
        self._safety = ThreeLayers()

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Begin an episode."""
        super().reset(road_map, model, seed)
        by_zone = self._ordering.by_zone if self._ordering is not None else not self.cda.binding
        self._perception = perception_at(self.cda, road_map, model, by_zone)
        agreed = AgreedOrder(RuleCoordinator(self.cda.binding)) if self.cda.negotiation else None
        self._negotiation = agreed or OwnOrders(self.cda.own_order, seed)

    def _assessed(
        self, moment: Moment, orders: Mapping[str, PassingOrder], deciding: Collection[str]
    ) -> dict[str, tuple[SafetyInput, tuple[ActionAssessment, ...]]]:
        """Check what each CAV may do."""
        lag = round(self.margin / moment.forecast.sample)
        expected = expect_all(moment, {ego: orders[ego] for ego in deciding}, lag)
        given = {ego: safety_input(moment, ego, orders[ego], expected[ego], lag) for ego in deciding}
        return {ego: (each, self._safety.assess(each)) for ego, each in given.items()}


class Filtered(Checked):
    """A method behind the safety check."""

    def act(self, world: WorldState) -> FilteredDeliberation:
        return self._check(world, self.method.act(world))

    def ask_once(self, world: WorldState) -> FilteredDeliberation:
        return self._check(world, self.method.ask_once(world))

    def _check(self, world: WorldState, deliberation: Deliberation) -> FilteredDeliberation:
        moment, actions = self._perception.perceive(world), deliberation.actions
        orders = self._orders(moment, deliberation)
        found = {}
        for ego, (given, assessed) in self._assessed(moment, orders, world.deciding).items():
            scene = given.scene
            near = nearest(actions[ego], assessed, scene.ego.speed, scene.intent.target_speed)
            taken = near[0] if len(near) == 1 else least_dangerous(given, near)
            found[ego] = FilteredAction(actions[ego], taken, assessed)
        replaced = [ego for ego, action in found.items() if action.taken is not action.wanted]
        if isinstance(self.method, Ordered):
            self.method.executor.not_driven(replaced)
        counts = {**deliberation.counts, "checked": len(found), "replaced": len(replaced)}
        return FilteredDeliberation(deliberation, found, counts, deliberation.transcript)

    def _orders(self, moment: Moment, deliberation: Deliberation) -> Mapping[str, PassingOrder]:
        """Return the order that each CAV goes by: that of the method if it orders, else that of ``codriving``."""
        if self._ordering is None or not isinstance(deliberation, ReasonedDeliberation):
            return self._negotiation.orders(moment)
        # Who may pass a zone before one that precedes it is not bound by the order.
        binds = not self._ordering.by_zone
        orders = {situation.scene.ego.id: situation.order for situation in deliberation.situations}
        return {ego: replace(order, binding=order.binding and binds) for ego, order in orders.items()}
