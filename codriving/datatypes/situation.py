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
        action: The action.
        safe: Whether it stays in the set of alternatives.
        reasons: Why it was removed, one entry a layer and vehicle.
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
        scene: What the CAV knows.
        conflicts: Conflicts that it is part of, most urgent first.
        order: The negotiated (or own) passing order.
        clear_times: When each conflict zone is expected to be free of those who go first [s]; 0 if the CAV goes first.
        assessments: The safety check of every available action.
        memories: Experiences retrieved for this scene, most similar first.
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
    """One semantic decision and its reason.

    Attributes:
        ego: Id of the CAV.
        action: The action.
        reason: Why, in one sentence.
        recalled: Numbers of the experiences that changed the decision.
    """

    ego: str
    action: Action
    reason: str
    recalled: tuple[int, ...] = ()
