"""Who teaches TeLL: a language model, or the rule that stands in for it offline."""

from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from codriving.datatypes import Action, DrivingModel, Model, Situation, WorldState
from codriving.errors import ConfigError
from codriving.geometry import RoadMap
from codriving.methods import Driver, SingleVehicle, prompted
from codriving.reasoning import HORIZON, rollout
from codriving.training.curriculum import Linear, at_least

if TYPE_CHECKING:
    from codriving.methods import CheckedDecider


@dataclass(frozen=True)
class Guidance:
    """How a student is guided (TeLL, Xu et al., 2025)."""

    llm: Model  # Who teaches: a language model, or ``offline`` for the driver below
    driver: Driver
    every: int
    pull: Linear

    def __post_init__(self) -> None:
        at_least(self, every=1)
        if min(self.pull.start, self.pull.end) < 0:
            raise ConfigError(f"pull must be 0 or more, got {self.pull.start:g} to {self.pull.end:g}")


class Advisor:
    """Decides for a CAV as a driver who is on its own would: by a rule, or by what a model says."""

    def __init__(self, guidance: Guidance, road_map: RoadMap, model: DrivingModel) -> None:
        # Drivers remember their CAVs by name, which is the same in all environments.
        self._alone = SingleVehicle(deepcopy(guidance.driver))
        self._every, self._road = guidance.every, (road_map, model)
        self._decider, self.asks = _decider(guidance.llm), True

    def advise(self, world: WorldState) -> Mapping[str, Action]:
        """Return what CAVs should do, by id."""
        if world.step == 0:
            # Nothing is drawn by those who drive alone, so that any seed will do.
            self._alone.reset(*self._road, 0)
        if not self.asks or world.step % self._every:
            return {}
        deliberation = self._alone.act(world)
        if self._decider is None:
            return deliberation.actions
        weighed = [_weighed(situation, *self._road) for situation in deliberation.situations]
        return {d.ego: d.action for d in self._decider.decide(weighed)}


def _weighed(situation: Situation, road_map: RoadMap, model: DrivingModel) -> Situation:
    """Say of each action how far it gets a CAV, and when to its conflicts, as a model is told of actions elsewhere."""
    ego, target = situation.scene.ego, situation.scene.intent.target_speed
    plans = tuple((a.action, Action.FASTER) for a in situation.assessments)
    steps = round(HORIZON / model.step)
    profile = road_map.speed_profiles(model).get(situation.scene.intent.route)
    way = () if profile is None else ((profile, situation.scene.place),)
    travelled = rollout(model, [ego.speed], [target], plans, steps, way)[0][0]
    weighed = []
    for assessment, places in zip(situation.assessments, travelled, strict=True):
        after = [int(np.searchsorted(places, c.distances[0])) for c in situation.conflicts]
        arrivals = tuple(k * model.step if k <= steps else float("inf") for k in after)
        weighed.append(replace(assessment, arrivals=arrivals, progress=float(places[-1])))
    return replace(situation, assessments=tuple(weighed))


def _decider(llm: Model) -> "CheckedDecider | None":
    if (model := prompted(llm)) is None:
        return None
    from codriving.methods import CheckedDecider

    return CheckedDecider(model, llm.ask_plain, sees_conflicts=True)
