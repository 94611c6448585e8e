"""What an executor is: it is handed an order and says what every CAV does now."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field

from codriving.datatypes.action import Action
from codriving.reasoning.moment import Moment
from codriving.reasoning.ordering.protocol import JointPlanner, Ordering
from codriving.reasoning.prediction.expectation import Expected
from codriving.reasoning.prediction.rollout import Plan


@dataclass(frozen=True, slots=True)
class Drive:
    """What an executor makes of an order.

    Attributes:
        progress: How far each CAV gets within the horizon after each first action with which it can keep the order
            [m], by id; no entry for an action with which it cannot.
    """

    actions: Mapping[str, Action]
    reasons: Mapping[str, str]
    expected: Mapping[str, tuple[Expected, ...]]
    progress: Mapping[str, Mapping[Action, float]]
    counts: Mapping[str, int] = field(default_factory=dict)


class Executor(ABC):
    """Turns passing orders into actions, step after step of one episode.

    Attributes:
        gap: Time between one vehicle's leaving a zone and the next one's entering it, for schedules [s].
        margin: The same for motions, and for the gap test of lane changes [s].
        library: Plans that it uses besides those that all methods predict.
    """

    name: str = ""
    gap: float
    margin: float
    library: tuple[Plan, ...] = ()

    def reset(self) -> None:  # noqa: B027
        """Begin an episode; nothing is remembered from the one before."""

    @abstractmethod
    def planner(self, moment: Moment) -> JointPlanner:
        """Return what plans all CAVs in an order; the rule uses it to choose the order."""

    @abstractmethod
    def drive(self, moment: Moment, ordering: Ordering) -> Drive:
        """Return what every CAV does now."""


def humans_expected(moment: Moment) -> dict[str, tuple[Expected, ...]]:
    """Expect each human driver that any CAV knows to keep its speed, on every way that it may take."""
    found: dict[str, tuple[Expected, ...]] = {}
    for known in moment.vehicles.values():
        for v in known.values():
            if not v.is_cav and v.id not in found:
                steady = moment.forecast.reach(v.speed, False).steady
                found[v.id] = tuple(Expected(route, place + steady, True, {}) for route, place in v.routes)
    return found
