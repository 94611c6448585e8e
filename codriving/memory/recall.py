"""What both kinds of memory have in common: how similar situations are found, and with which settings."""

from collections.abc import Sequence

from codriving.datatypes import CaseMemory, Memory, MetDriver, Situation
from codriving.errors import ConfigError
from codriving.memory.describe import describe
from codriving.memory.embedders import LITELLM, EmbeddingServer, make_embedder
from codriving.memory.snapshot import Snapshot


class RetrievalMemory(CaseMemory):
    """Memory retrieval (paper Section III-D.2): the most similar experiences by cosine."""

    def __init__(self, shots: int, least_similarity: float, embedder: str, server: EmbeddingServer) -> None:
        if not 1 <= shots <= 50:
            raise ConfigError(f"shots must be 1 to 50, got {shots}")
        if not -1 <= least_similarity <= 1:
            raise ConfigError(f"least_similarity must be -1 to 1, got {least_similarity:g}")
        self._shots, self._least_similarity = shots, least_similarity
        self._embedder, self.asks = make_embedder(embedder, server), embedder == LITELLM
        self._snapshot: Snapshot | None = None

    def encounters(self) -> Sequence[MetDriver]:
        """Return what human drivers did who were met in the interactions that are recalled from."""
        return () if self._snapshot is None else self._snapshot.encounters

    def recall(self, situations: Sequence[Situation]) -> list[tuple[Memory, ...]]:
        """Find what is similar to each situation."""
        if not self._snapshot or not situations:
            return [()] * len(situations)
        vectors = self._embedder.embed(list(map(describe, situations)))
        least = self._least_similarity
        least = least if self._embedder.calibrated else self._snapshot.equivalent(least)
        return self._snapshot.search(vectors, self._shots, least)
