"""One moment as an executor sees it: everybody's knowledge together, since all CAVs are planned jointly."""

from collections.abc import Mapping
from dataclasses import dataclass

from codriving.datatypes.action import Action
from codriving.datatypes.conflict import Conflict
from codriving.datatypes.scene_description import SceneDescription, TrackedVehicle
from codriving.geometry.road_map import RoadMap
from codriving.reasoning.prediction.forecast import Forecast


@dataclass(frozen=True, slots=True)
class Stage:
    """One moment.

    Attributes:
        time: Simulated time [s].
    """

    scenes: Mapping[str, SceneDescription]
    conflicts: Mapping[str, tuple[Conflict, ...]]
    known: Mapping[str, dict[str, TrackedVehicle]]
    available: Mapping[str, tuple[Action, ...]]
    road_map: RoadMap
    forecast: Forecast
    time: float
