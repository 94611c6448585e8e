"""What a CAV that learns on its own is handed: its features, what it may do, and the advice of a teacher."""

import numpy as np

from codriving.datatypes import DrivingModel, WorldState
from codriving.geometry import RoadMap
from codriving.gym import Observer
from codriving.methods import ACTIONS, Features, FloatArray, allowed, feature_count
from codriving.training.teacher import Advisor


class AdvisedObserver(Observer):
    """Three rows in one: features, 1 for each action that is allowed, and 1 for the action that the teacher advises.

    The network sees the features alone. Masks and advice go the same way because Stable-Baselines3 keeps nothing else
    of a step.
    """

    def __init__(self, road_map: RoadMap, model: DrivingModel, family: str, teacher: Advisor | None) -> None:
        self._features = Features(road_map, model, family, shared=False)
        self._family, self._teacher = family, teacher

    def nothing(self) -> FloatArray:
        """Return what is observed by a CAV that has left the road."""
        return np.zeros(feature_count(self._family) + 2 * len(ACTIONS[self._family]), dtype=np.float32)

    def observe(self, world: WorldState) -> dict[str, FloatArray]:
        """Return what each CAV on the road is handed."""
        if world.step == 0:
            self._features.reset()
        actions = ACTIONS[self._family]
        advice = {} if self._teacher is None else self._teacher.advise(world)
        return {
            name: np.concatenate(
                [seen, allowed(self._family, world.available[name]), [a is advice.get(name) for a in actions]],
                dtype=np.float32,
            )
            for name, seen in self._features.observe(world).items()
        }
