"""Deciders that a control puts in the place of a decision: the fastest action that is allowed, and a random one."""

from collections.abc import Sequence

import numpy as np

from codriving.datatypes import Decision, Situation
from codriving.reasoning.decision.rules import Decider
from codriving.reasoning.safety.safety_input import LONGITUDINAL


class FastestDecider(Decider):
    """Takes the fastest allowed action; lanes are changed where the route asks for it, as soon as that is allowed."""

    def decide(self, situations: Sequence[Situation]) -> list[Decision]:
        """Return one decision a situation, in the same order."""
        return [_fastest(situation) for situation in situations]


def _fastest(situation: Situation) -> Decision:
    scene, allowed, change = situation.scene, situation.allowed, situation.scene.must_change
    if change is not None and change.action in allowed:
        return Decision(scene.ego.id, change.action, f"the route asks for {change.action}, and it is allowed")
    along = [action for action in allowed if action in LONGITUDINAL]
    # Where IDLE and HOLD are as fast, IDLE comes first.
    action = max(along or allowed, key=lambda a: scene.speed_rank(a) or 0.0)
    return Decision(scene.ego.id, action, f"{action} is the fastest action that is allowed")


class RandomDecider(Decider):
    """Draws one of the allowed actions, lane changes included, with equal chances.

    Seed, decision step and id of a CAV tell what is drawn for it, however many others there are and in whatever order.
    """

    def reset(self, seed: int) -> None:
        """Begin an episode."""
        self._seed, self._step = seed, 0

    def decide(self, situations: Sequence[Situation]) -> list[Decision]:
        """Return one decision a situation, in the same order."""
        self._step += 1
        return [self._draw(situation) for situation in situations]

    def _draw(self, situation: Situation) -> Decision:
        name, allowed = situation.scene.ego.id, situation.allowed
        key = np.random.SeedSequence(entropy=self._seed, spawn_key=(self._step, *name.encode()))
        action = allowed[int(np.random.default_rng(key).integers(len(allowed)))]
        return Decision(name, action, f"{action} was drawn from {', '.join(allowed)}")
