"""How long a thought takes: as long as is stated, or as the answers of a language model took."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

NONE, MEASURED = "none", "measured"  # Words that ``llm.latency`` takes besides a time

ORDERS = "negotiate"  # Purpose of the questions about orders; all others of a step are about decisions

EARLY = 1e-6  # By so much an answer may come late and still be in time: sums of steps are not exact [s]

# Purpose and subject of each question of a step, and how long each of its requests took [s].
Asked = Sequence[tuple[str, str, Sequence[float]]]


@dataclass(frozen=True, slots=True)
class Delays:
    """How long decisions and orders take."""

    mind: float  # [s]
    order: float  # [s]
    latency: str | float = NONE  # How long each question to a language model takes, in the place of both

    def __str__(self) -> str:
        if self.by_model:
            return f"llm.latency={self.latency}"
        stated = (("mind", self.mind), ("order", self.order))
        return ", ".join(f"thinking.{key}={value:g} s" for key, value in stated if value)

    @property
    def by_model(self) -> bool:
        """Whether the questions to a language model say how long a thought takes."""
        return self.latency != NONE

    def of_order(self, asked: Asked) -> float:
        """Return how long the order of this step takes [s]."""
        return self._longest(calls for purpose, _, calls in asked if purpose == ORDERS) if self.by_model else self.order

    def of_mind(self, asked: Asked, ego: str) -> float:
        """Return how long the decision of one CAV takes [s]."""
        if not self.by_model:
            return self.mind
        return self._longest(calls for purpose, subject, calls in asked if purpose != ORDERS and subject == ego)

    def _longest(self, questions: Iterable[Sequence[float]]) -> float:
        """Return the time of the question that takes longest; what is asked again takes its time again [s]."""
        if isinstance(self.latency, float):
            return max((self.latency * len(calls) for calls in questions), default=0.0)
        return max((sum(calls) for calls in questions), default=0.0)
