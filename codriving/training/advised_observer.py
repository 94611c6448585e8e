"""What a CAV that learns on its own is handed: its features, what it may do, and the advice of a teacher."""

import numpy as np

from codriving.datatypes.action import Action
from codriving.datatypes.driving_model import DrivingModel
from codriving.datatypes.world import WorldState
from codriving.geometry.road_map import RoadMap
from codriving.gym.observation import Observer
from codriving.methods.learned.features import Features
from codriving.methods.learned.layout import ACTIONS, allowed, feature_count
from codriving.methods.learned.network import FloatArray
from codriving.training.teacher import Teacher


class AdvisedObserver(Observer):
    """Three rows in one: features, 1 for each action that is allowed, and 1 for the action that the teacher advises.

    The network sees the features alone. Masks and advice go the same way because Stable-Baselines3 keeps nothing else
    of a step.

    Args:
        family: ``junction`` or ``lanes``.
        teacher: Gives advice; None for no advice.
    """

    def __init__(self, road_map: RoadMap, model: DrivingModel, family: str, teacher: Teacher | None) -> None:
        self._features = Features(road_map, model, family, shared=False)
        self._family, self._teacher = family, teacher
        self._nothing = np.zeros(feature_count(family) + 2 * len(ACTIONS[family]), dtype=np.float32)

    def nothing(self) -> FloatArray:
        """Return what is observed by a CAV that has left the road."""
        return self._nothing.copy()

    def observe(self, world: WorldState) -> dict[str, FloatArray]:
        """Return what each CAV on the road is handed."""
        if world.step == 0:
            self._features.reset()
        advice = {} if self._teacher is None else self._teacher.advise(world)
        return {
            name: np.concatenate([seen, self._mask(world, name), self._row(advice.get(name))], dtype=np.float32)
            for name, seen in self._features.observe(world).items()
        }

    def _mask(self, world: WorldState, name: str) -> FloatArray:
        return allowed(self._family, world.available[name]).astype(np.float32)

    def _row(self, action: Action | None) -> FloatArray:
        return np.array([known is action for known in ACTIONS[self._family]], dtype=np.float32)
