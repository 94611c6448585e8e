"""One moment: what has been perceived at one time, with the road and the forecast."""

from collections.abc import Mapping
from dataclasses import dataclass

from codriving.datatypes.action import Action
from codriving.datatypes.conflict import Conflict
from codriving.datatypes.scene_description import SceneDescription, TrackedVehicle
from codriving.geometry.road_map import RoadMap
from codriving.reasoning.prediction.forecast import Forecast


@dataclass(frozen=True, slots=True)
class Moment:
    """All that the CAVs know at one time, each by its id; functions are handed ``(moment, ego)``.

    Attributes:
        vehicles: The vehicles that each CAV knows of, itself included, by id.
        sees_conflicts: Whether conflicts can be told at all, which takes routes that are shared or guessed.
    """

    time: float  # Simulated time [s]
    scenes: Mapping[str, SceneDescription]
    conflicts: Mapping[str, tuple[Conflict, ...]]
    vehicles: Mapping[str, dict[str, TrackedVehicle]]
    available: Mapping[str, tuple[Action, ...]]
    road_map: RoadMap
    forecast: Forecast
    sees_conflicts: bool = True
