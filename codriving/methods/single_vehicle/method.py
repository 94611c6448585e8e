"""Methods for a single vehicle: each CAV by itself, by what it sees; a driver decides, the rest is shared."""

from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field

from codriving.datatypes import (
    Action,
    ActionAssessment,
    Decision,
    DrivingModel,
    Method,
    PassingOrder,
    Precedence,
    ReasonedDeliberation,
    Situation,
    WorldState,
)
from codriving.geometry import RoadMap
from codriving.reasoning import SLOWEST, Forecast, Moment, single_vehicle_perception


@dataclass(frozen=True, slots=True)
class Choice:
    """What a driver does, and why."""

    action: Action
    reason: str
    precedences: tuple[Precedence, ...] = ()
    refused: Mapping[Action, str] = field(default_factory=dict)
    counts: Mapping[str, int] = field(default_factory=dict)


class Driver(ABC):
    """Drives CAVs of which each decides alone; the same rules for all of them."""

    name: str = ""
    variant: str = ""

    def reset(self) -> None:
        """Begin an episode; nothing is remembered from the one before."""
        return None

    @abstractmethod
    def decide(self, moment: Moment, ego: str) -> Choice:
        """Decide for one CAV."""


class SingleVehicle(Method):
    """A method by which every CAV decides alone.

    Nothing is shared or negotiated: a CAV knows position, speed and heading of those around it, and the map.
    """

    def __init__(self, driver: Driver) -> None:
        self.driver = driver
        self.name, self.variant = driver.name, driver.variant

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Begin an episode; nothing is remembered from the one before."""
        self._perception = single_vehicle_perception(road_map, Forecast(model, (), road_map))
        self.driver.reset()

    def act(self, world: WorldState) -> ReasonedDeliberation:
        """Decide for every CAV on the road, one by one."""
        moment = self._perception.perceive(world)
        situations, decisions, counts = [], [], Counter[str]()
        for ego in moment.scenes:
            choice = self.driver.decide(moment, ego)
            situations.append(account(moment, ego, choice))
            decisions.append(Decision(ego, choice.action, choice.reason))
            counts.update(choice.counts)
        return ReasonedDeliberation(world.time, world.step, tuple(situations), tuple(decisions), dict(counts))


def account(moment: Moment, ego: str, choice: Choice) -> Situation:
    """Write down what a decision rests on, in the form in which every method's decisions are recorded."""
    scene, conflicts = moment.scenes[ego], moment.conflicts[ego]
    speeds = {n.id: n.speed for n in scene.neighbours}
    before = [p.first for p in choice.precedences if p.second == ego]
    after = [p.second for p in choice.precedences if p.first == ego]
    sequence = (*before, ego, *after) if choice.precedences else ()
    clear_times = tuple(
        max(c.exits[1], 0.0) / max(speeds[c.other], SLOWEST) if c.other in before else 0.0 for c in conflicts
    )
    refused = [(action, choice.refused.get(action, "")) for action in moment.available[ego]]
    assessments = tuple(ActionAssessment(action, not why, (why,) if why else (), (), None) for action, why in refused)
    return Situation(scene, conflicts, PassingOrder(sequence, choice.precedences), clear_times, assessments)
