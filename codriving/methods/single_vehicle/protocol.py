"""What a driver on its own is: it is handed one CAV's view and says what that CAV does now."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field

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
    """What a driver does, and why."""

    action: Action
    reason: str
    precedences: tuple[Precedence, ...] = ()
    refused: Mapping[Action, str] = field(default_factory=dict)
    counts: Mapping[str, int] = field(default_factory=dict)


class Driver(ABC):
    """Drives CAVs of which each is on its own; the same rules for all of them."""

    name: str = ""
    variant: str = ""

    def reset(self) -> None:
        """Begin an episode; nothing is remembered from the one before."""
        return None

    @abstractmethod
    def decide(self, view: View) -> Choice:
        """Decide for one CAV."""
