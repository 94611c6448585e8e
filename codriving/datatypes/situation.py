"""Everything a decider is told about one CAV; rules and language models get the same."""

from dataclasses import dataclass

from codriving.datatypes.action import Action
from codriving.datatypes.conflict import Conflict
from codriving.datatypes.experience import Memory
from codriving.datatypes.order import PassingOrder
from codriving.datatypes.scene_description import SceneDescription


@dataclass(frozen=True, slots=True)
class ActionAssessment:
    """What the three-layer safety check says of one action.

    Attributes:
        arrivals: Earliest time to reach each conflict zone of the ego vehicle after this action and then full
            speed [s]; inf if never.
        progress: How far the CAV gets within the horizon if it then keeps the order [m]; None if it cannot keep it.
    """

    action: Action
    safe: bool
    reasons: tuple[str, ...]
    arrivals: tuple[float, ...]
    progress: float | None


@dataclass(frozen=True, slots=True)
class Situation:
    """The input of one decision.

    Attributes:
        clear_times: When each conflict zone is expected to be free of those who go first [s]; 0 if the CAV goes first.
    """

    scene: SceneDescription
    conflicts: tuple[Conflict, ...]
    order: PassingOrder
    clear_times: tuple[float, ...]
    assessments: tuple[ActionAssessment, ...]
    memories: tuple[Memory, ...] = ()

    @property
    def allowed(self) -> tuple[Action, ...]:
        """Actions that the safety check left over."""
        return tuple(a.action for a in self.assessments if a.safe)


@dataclass(frozen=True, slots=True)
class Decision:
    """One semantic decision and its reason."""

    ego: str
    action: Action
    reason: str
    recalled: tuple[int, ...] = ()
