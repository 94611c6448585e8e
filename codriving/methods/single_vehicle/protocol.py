"""What a driver on its own is: it is handed one CAV's view and says what that CAV does now."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol

from codriving.datatypes.action import Action
from codriving.datatypes.conflict import Conflict
from codriving.datatypes.order import Precedence
from codriving.datatypes.scene_description import SceneDescription
from codriving.geometry.road_map import RoadMap
from codriving.reasoning.prediction.forecast import Forecast


@dataclass(frozen=True, slots=True)
class View:
    """One CAV's view of one moment.

    Attributes:
        scene: What it sees; nobody in it has an intent, or is known to be a CAV.
        conflicts: Its conflicts with all ways that the map allows the others, most urgent first.
        actions: Actions that the road allows it.
        road_map: The precomputed road.
        forecast: Predictions of this step.
        time: Simulated time [s].
    """

    scene: SceneDescription
    conflicts: tuple[Conflict, ...]
    actions: tuple[Action, ...]
    road_map: RoadMap
    forecast: Forecast
    time: float

    @property
    def top(self) -> float:
        """Highest target speed [m/s]."""
        return self.forecast.model.target_speeds[-1]


@dataclass(frozen=True, slots=True)
class Choice:
    """What a driver does, and why.

    Attributes:
        action: The action.
        reason: Why, in one sentence.
        precedences: Who goes first, in its own view, wherever it is open.
        refused: Why it leaves out actions, by action.
        counts: Counters of the decision.
    """

    action: Action
    reason: str
    precedences: tuple[Precedence, ...] = ()
    refused: Mapping[Action, str] = field(default_factory=dict)
    counts: Mapping[str, int] = field(default_factory=dict)


class Driver(Protocol):
    """Drives CAVs of which each is on its own; the same rules for all of them.

    Attributes:
        name: Name of the method in tables.
        variant: Name of the variant in tables.
    """

    name: str
    variant: str

    def reset(self) -> None:
        """Begin an episode; nothing is remembered from the one before."""
        ...

    def decide(self, view: View) -> Choice:
        """Decide for one CAV.

        Args:
            view: What it sees.
        """
        ...
