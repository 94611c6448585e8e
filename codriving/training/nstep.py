"""Transitions over several steps, one agent at a time; an agent that has arrived has none after its arrival."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from codriving.methods import Observation


class Transition(NamedTuple):
    """What the learning rule learns from."""

    observation: Observation
    action: int
    gain: float
    discount: float
    later: Observation
    mask: NDArray[np.bool_]


class _Step(NamedTuple):
    observation: Observation
    mask: NDArray[np.bool_]
    action: int
    reward: float


class Trail:
    """What one agent has gone through in the present episode."""

    def __init__(self, steps: int, discount: float) -> None:
        self._n, self._discount = steps, discount
        self._steps: list[_Step] = []

    def add(self, observation: Observation, mask: NDArray[np.bool_], action: int, reward: float) -> None:
        """Note one decision and what it brought."""
        self._steps.append(_Step(observation, mask, action, reward))

    def full(self, later: Observation, mask: NDArray[np.bool_]) -> list[Transition]:
        """Return the transition that spans n steps up to now, if there are so many."""
        if len(self._steps) < self._n:
            return []
        found = self._sum(0, later, mask, ended=False)
        del self._steps[0]
        return [found]

    def ended(self) -> list[Transition]:
        """Return what is left of an agent that has arrived or crashed: nothing comes after it."""
        found = [self._sum(k, s.observation, s.mask, ended=True) for k, s in enumerate(self._steps)]
        self._steps = []
        return found

    def cut(self, later: Observation, mask: NDArray[np.bool_]) -> list[Transition]:
        """Return what is left of an agent whose episode was cut off by the time limit: it would have gone on."""
        found = [self._sum(k, later, mask, ended=False) for k in range(len(self._steps))]
        self._steps = []
        return found

    def dropped(self) -> list[Transition]:
        """Return what is left of an agent whose episode was broken off by others: all but its last step."""
        if not self._steps:
            return []
        last = self._steps.pop()
        return self.cut(last.observation, last.mask)

    def _sum(self, first: int, later: Observation, mask: NDArray[np.bool_], ended: bool) -> Transition:
        steps = self._steps[first : first + self._n]
        gain, weight = 0.0, 1.0
        for step in steps:
            gain += weight * step.reward
            weight *= self._discount
        return Transition(steps[0].observation, steps[0].action, gain, 0.0 if ended else weight, later, mask)
