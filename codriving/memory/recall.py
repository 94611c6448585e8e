"""What both kinds of memory have in common: how similar situations are found, and with which settings."""

from collections.abc import Sequence
from dataclasses import dataclass

from codriving.datatypes.experience import Memory
from codriving.datatypes.situation import Situation
from codriving.errors import ConfigError
from codriving.memory.describe import describe
from codriving.memory.embedder import Embedder
from codriving.memory.recollection import Recollection


@dataclass(frozen=True, slots=True)
class Recall:
    """Memory retrieval (paper Section III-D.2): the most similar experiences by cosine.

    Raises:
        ConfigError: If a setting is out of range.
    """

    shots: int
    least_similarity: float

    def __post_init__(self) -> None:
        if not 1 <= self.shots <= 50:
            raise ConfigError(f"shots must be 1 to 50, got {self.shots}")
        if not -1 <= self.least_similarity <= 1:
            raise ConfigError(f"least_similarity must be -1 to 1, got {self.least_similarity:g}")

    def find(
        self, recollection: Recollection, embedder: Embedder, situations: Sequence[Situation]
    ) -> list[tuple[Memory, ...]]:
        """Find what is like each situation.

        Returns:
            The memories of each, most similar first.
        """
        if not len(recollection) or not situations:
            return [()] * len(situations)
        vectors = embedder.embed([describe(situation) for situation in situations])
        return recollection.search(vectors, self.shots, self.least_similarity)
