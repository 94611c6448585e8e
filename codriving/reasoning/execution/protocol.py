"""What an executor is: it is handed an order and says what every CAV does now."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol

from codriving.datatypes.action import Action
from codriving.reasoning.execution.stage import Stage
from codriving.reasoning.ordering.protocol import JointPlanner, Ordering
from codriving.reasoning.prediction.expectation import Expected


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


class Executor(Protocol):
    """Turns passing orders into actions, step after step of one episode.

    Attributes:
        gap: Time between one vehicle's leaving a zone and the next one's entering it, for schedules [s].
        margin: The same for motions, and for the gap test of lane changes [s].
    """

    name: str
    gap: float
    margin: float

    def reset(self) -> None:
        """Begin an episode; nothing is remembered from the one before."""
        ...

    def planner(self, stage: Stage) -> JointPlanner:
        """Return what plans for everybody in an order; it is asked before the order is chosen."""
        ...

    def drive(self, stage: Stage, ordering: Ordering) -> Drive:
        """Return what every CAV does now."""
        ...
