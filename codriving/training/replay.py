"""The last transitions, from which batches are drawn."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codriving.methods import FloatArray
from codriving.training.nstep import Transition


@dataclass(frozen=True, slots=True)
class Batch:
    """Some transitions, one a row."""

    observations: FloatArray  # What was observed (n, features)
    actions: NDArray[np.int64]  # Numbers of the actions (n,)
    gains: FloatArray  # Discounted sums of rewards (n,)
    discounts: FloatArray  # What the value of the last observation counts (n,)
    later: FloatArray  # Last observations (n, features)
    masks: NDArray[np.bool_]  # Actions that are allowed then (n, actions)


class Replay:
    """A ring of transitions; the oldest is overwritten first."""

    def __init__(self, capacity: int, features: int, actions: int) -> None:
        self.capacity, self.added = capacity, 0
        self._columns: dict[str, NDArray[np.generic]] = {
            "observations": np.zeros((capacity, features), np.float32),
            "actions": np.zeros(capacity, np.int64),
            "gains": np.zeros(capacity, np.float32),
            "discounts": np.zeros(capacity, np.float32),
            "later": np.zeros((capacity, features), np.float32),
            "masks": np.zeros((capacity, actions), np.bool_),
        }

    def __len__(self) -> int:
        return min(self.added, self.capacity)

    def add(self, transition: Transition) -> None:
        """Take one in."""
        k = self.added % self.capacity
        values: tuple[Any, ...] = transition
        for column, value in zip(self._columns.values(), values, strict=True):
            column[k] = value
        self.added += 1

    def draw(self, size: int, rng: np.random.Generator) -> Batch:
        """Draw a batch; a transition may be in it twice."""
        chosen = rng.integers(len(self), size=size)
        return Batch(**{name: column[chosen] for name, column in self._columns.items()})  # type: ignore[arg-type]

    def state(self) -> dict[str, NDArray[np.generic]]:
        """Return everything that it holds, by name."""
        return {name: column[: len(self)] for name, column in self._columns.items()} | {"added": np.array(self.added)}

    def restore(self, state: dict[str, NDArray[np.generic]]) -> None:
        """Go on with what another one held."""
        self.added = int(state["added"])
        for name, column in self._columns.items():
            column[: len(self)] = state[name]
