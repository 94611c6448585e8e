"""What all CAVs know at one moment, which every method begins with: states, intents, scenes and conflicts."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from codriving.datatypes import Action, Conflict, DrivingModel, Judgements, SceneDescription, TrackedVehicle, WorldState
from codriving.geometry import RoadMap
from codriving.reasoning.conflicts import find_conflicts
from codriving.reasoning.prediction.forecast import Forecast, State
from codriving.reasoning.prediction.right_of_way import GivesWay, gives_way
from codriving.reasoning.sharing.scenes import describe_scenes, with_conflicts
from codriving.reasoning.sharing.sharing import GUESSED_INTENTS, IntentSharing, SensedStates, StateSharing
from codriving.reasoning.sharing.tracking import Tracking


@dataclass(frozen=True, slots=True)
class Moment:
    """All that the CAVs know at one time, each by its id; functions are handed ``(moment, ego)``."""

    time: float  # Simulated time [s]
    scenes: Mapping[str, SceneDescription]
    conflicts: Mapping[str, tuple[Conflict, ...]]
    vehicles: Mapping[str, dict[str, TrackedVehicle]]  # The vehicles that each CAV knows of, itself included, by id
    available: Mapping[str, tuple[Action, ...]]
    road_map: RoadMap
    forecast: Forecast
    sees_conflicts: bool = True  # Whether conflicts can be told at all, which takes routes that are shared or guessed
    gives_way: GivesWay = gives_way  # Says why a human driver is expected to let the CAV pass first
    # Whether a CAV may pass a zone before one that precedes it in the order, if it is out of its way in time.
    by_zone: bool = False
    judgements: Judgements = field(default_factory=dict)  # What `gives_way` goes by, by CAV and driver


@dataclass(slots=True)
class Perception:
    """The first half of every method: share states, share intents, find conflicts."""

    road_map: RoadMap
    forecast: Forecast
    tracking: Tracking
    state_sharing: StateSharing
    intent_sharing: IntentSharing
    may_hold: bool = True  # Whether those who decide know HOLD
    gives_way: GivesWay = gives_way  # As in `Moment`
    by_zone: bool = False  # As in `Moment`

    def perceive(self, world: WorldState) -> Moment:
        """Return what every CAV knows, and begin the predictions of this step."""
        self.forecast.begin_step(states(world, self.road_map, self.forecast.model))
        detections = self.state_sharing.detections(world, self.forecast.model)
        scenes = describe_scenes(world, detections, self.intent_sharing.intents(world), self.tracking)
        conflicts: dict[str, tuple[Conflict, ...]] = dict.fromkeys(scenes, ())
        finds_conflicts = self.intent_sharing.finds_conflicts
        if finds_conflicts:
            conflicts = {ego: find_conflicts(scene, self.road_map) for ego, scene in scenes.items()}
            scenes = {ego: with_conflicts(scene, conflicts[ego], self.road_map) for ego, scene in scenes.items()}
        vehicles = {ego: scene.vehicles() for ego, scene in scenes.items()}
        available = world.available
        if not self.may_hold:
            available = {name: tuple(a for a in known if a is not Action.HOLD) for name, known in available.items()}
        known = (scenes, conflicts, vehicles, available, self.road_map, self.forecast, finds_conflicts)
        return Moment(world.time, *known, self.gives_way, self.by_zone)


def states(world: WorldState, road_map: RoadMap, model: DrivingModel) -> list[State]:
    """Return speed, target speed and place of each CAV; where vehicles have no limits the place makes no difference."""
    found = []
    for cav in world.cavs:
        intent = world.intents[cav.id]
        place = 0.0 if model.limits is None else road_map.project(intent.route, cav.x, cav.y)[0]
        found.append((cav.speed, intent.target_speed, intent.route, place))
    return found


def single_vehicle_perception(road_map: RoadMap, forecast: Forecast) -> Perception:
    """Return what a vehicle perceives that is on its own: what its sensors tell, and what the map allows.

    It knows position, speed and heading of every vehicle within the detection range, cannot tell a CAV from a human
    driver, and knows the ways that each may take from the map, narrowed down as it watches. Routes, intents, actions
    and negotiated orders of others stay hidden. HOLD is none of its actions.
    """
    return Perception(road_map, forecast, Tracking(road_map), SensedStates(headings=True), GUESSED_INTENTS, False)
