"""Episodes driven to the end, moments as an executor sees them, and CAVs that do exactly what is predicted."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import yaml
from worlds import Car, Junction, Thoughts

from codriving.config.locate import conf_dir
from codriving.datatypes.experience import Interaction
from codriving.datatypes.parts import Method
from codriving.datatypes.record import Outcome, Trajectory
from codriving.datatypes.situation import ReasonedDeliberation
from codriving.datatypes.world import Action, Kind, WorldState
from codriving.environment.environment import Environment
from codriving.methods.fcfs import FirstComeFirstServed
from codriving.methods.language_model.prompted_model import ModelMethod
from codriving.methods.ordered import Ordered
from codriving.reasoning.execution.layered import Layered
from codriving.reasoning.execution.planned import Executor, Planned
from codriving.reasoning.ordering.protocol import Ordering, OrderRule
from codriving.reasoning.perception import Moment
from codriving.reasoning.prediction.rollout import rollout


def configured_executor(name: str) -> dict[str, Any]:
    """The settings of an executor in the configuration."""
    text = (conf_dir() / "executor" / f"{name}.yaml").read_text(encoding="utf-8")
    return {key: value for key, value in yaml.safe_load(text).items() if key != "_target_"}


def planned(**change: Any) -> Planned:
    """The executor as it is configured, but for what is named."""
    return Planned(**{**configured_executor("planned"), **change})


def layered(**change: Any) -> Layered:
    """The reference executor as it is configured, but for what is named."""
    return Layered(**{**configured_executor("layered"), **change})


def ordered(world: Junction, rule: OrderRule | None = None, executor: Executor | None = None, seed: int = 0) -> Ordered:
    """A method that orders, ready for an episode; first come, first served and the planned executor by default."""
    made = Ordered(rule or FirstComeFirstServed(), executor or planned())
    made.reset(world.road_map, world.model, seed)
    return made


def moment_of(thoughts: Thoughts, time: float = 0.0) -> Moment:
    """One moment as an executor sees it."""
    return thoughts.moment(time)


def ordering_of(*sequence: str, **times: float) -> Ordering:
    """An order that is given; who is not timed passes one second after the one before."""
    return Ordering(sequence, {name: times.get(name, float(k)) for k, name in enumerate(sequence)})


@dataclass(frozen=True)
class Episode:
    """What was seen, decided and driven."""

    worlds: tuple[WorldState, ...]
    steps: tuple[ReasonedDeliberation, ...]
    trajectory: Trajectory
    outcome: Outcome | None

    @property
    def actions(self) -> list[dict[str, Action]]:
        """What each vehicle did at each decision."""
        return [step.actions for step in self.steps]


def drive(environment: Environment, method: Method, seed: int, decisions: int = 10_000) -> Episode:
    """Drive one episode to its end, or for some decisions."""
    world = environment.reset(seed)
    if isinstance(method, ModelMethod) and method.memory is not None:
        name = environment.road_map.road.name
        method.memory.begin(Interaction(name, seed, method.name, method.variant, method.reasoner))
    method.reset(environment.road_map, environment.driving_model, seed)
    worlds = [world]
    steps: list[ReasonedDeliberation] = []
    while environment.outcome is None and len(steps) < decisions:
        steps.append(method.act(world))
        world = environment.step(steps[-1].actions)
        worlds.append(world)
    return Episode(tuple(worlds), tuple(steps), environment.trajectory(), environment.outcome)


def obey(junction: Junction, car: Car, action: Action) -> tuple[Car, np.ndarray]:
    """One decision later, a CAV that is on its route exactly; and where it was at each simulation step [m]."""
    model = junction.model
    speeds = model.target_speeds
    target = car.target
    if action in (Action.FASTER, Action.SLOWER):
        index = int(np.rint(np.clip((car.speed - speeds[0]) / (speeds[-1] - speeds[0]), 0, 1) * (len(speeds) - 1)))
        target = speeds[int(np.clip(index + (1 if action is Action.FASTER else -1), 0, len(speeds) - 1))]
    distances, reached = rollout(model, [car.speed], [car.target], ((action,),), model.substeps)
    places = car.place + distances[0, 0]
    after = replace(car, place=float(places[-1]), speed=float(max(reached[0, 0, -1], 0.0)), target=target)
    return after, places


@dataclass(frozen=True)
class Show:
    """How puppets moved: the arc length of each vehicle at every simulation step, by id; who has left counts as inf."""

    places: dict[str, np.ndarray]
    steps: tuple[ReasonedDeliberation, ...]

    def arrived(self, name: str) -> bool:
        """Whether a vehicle has reached its goal."""
        return bool(np.isinf(self.places[name][-1]))


def puppets(junction: Junction, method: Method, cars: Sequence[Car], seconds: float) -> Show:
    """Let CAVs do exactly what is predicted among human drivers who keep their speed, whatever happens."""
    model = junction.model
    now = {car.id: car for car in cars}
    places: dict[str, list[float]] = {car.id: [car.place] for car in cars}
    steps: list[ReasonedDeliberation] = []
    for k in range(round(seconds / model.decision_interval)):
        world = junction.world(*now.values(), time=k * model.decision_interval, step=k)
        steps.append(method.act(world))
        actions = steps[-1].actions
        for name in places:
            if name not in now:
                places[name] += [np.inf] * model.substeps
                continue
            car = now[name]
            if car.kind is Kind.CAV:
                now[name], along = obey(junction, car, actions[name])
            else:
                along = car.place + car.speed * model.step * np.arange(model.substeps + 1)
                now[name] = replace(car, place=float(along[-1]))
            places[name] += along[1:].tolist()
            if now[name].place > junction.road_map.routes[car.route].goal:
                del now[name]
    return Show({name: np.array(s) for name, s in places.items()}, tuple(steps))
