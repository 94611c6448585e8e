"""A trained network in numpy: two hidden layers of rectifiers, then one number an action."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class Network:
    """A multilayer perceptron."""

    weights: Sequence[FloatArray]
    biases: Sequence[FloatArray]

    def __call__(self, observations: FloatArray) -> FloatArray:
        """Return what the network makes of some observations.

        Args:
            observations: One a row (n, inputs).

        Returns:
            One row each (n, outputs).
        """
        hidden = observations
        last = len(self.weights) - 1
        for layer, (weight, bias) in enumerate(zip(self.weights, self.biases, strict=True)):
            hidden = hidden @ weight + bias
            if layer != last:
                hidden = np.maximum(hidden, 0.0)
        return hidden


def greedy(values: FloatArray, masks: NDArray[np.bool_]) -> list[int]:
    """Return the best allowed action of each row; of several alike the first.

    Args:
        values: Value of each action (n, actions).
        masks: Whether it is allowed (n, actions); at least one in each row is.
    """
    return [int(k) for k in np.where(masks, values, -np.inf).argmax(axis=1)]


def shares(logits: FloatArray, masks: NDArray[np.bool_]) -> FloatArray:
    """Return the probabilities of a policy (n, actions); what is not allowed has none.

    Args:
        logits: What the network makes of each action (n, actions).
        masks: Whether it is allowed (n, actions); at least one in each row is.
    """
    if not len(logits):
        return logits
    allowed = np.where(masks, logits, -np.inf)
    weights = np.exp(allowed - allowed.max(axis=1, keepdims=True))
    return np.asarray(weights / weights.sum(axis=1, keepdims=True), dtype=np.float32)
