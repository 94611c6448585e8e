"""The vectors of a memory, searched by cosine: FAISS finds who may be nearest, ties are broken by age."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from codriving.memory.embedders import Vectors

_SPARE = 8  # Candidates beyond those wanted, among which ties are broken

_DIGITS = 6  # Digits of a similarity that count; what differs less is a tie

Hit = tuple[int, float]  # Number of an experience and its cosine similarity


class Index:
    """A flat index in memory: exact, and made anew whenever a file is opened."""

    def __init__(self, dimension: int) -> None:
        import faiss

        # One thread: the machine's cores belong to the episodes. One pass over the vectors for all queries of a step.
        faiss.omp_set_num_threads(1)
        faiss.cvar.distance_compute_blas_threshold = 2
        self._flat = faiss.IndexFlatIP(dimension)
        self.dimension = dimension
        self.ids: list[int] = []

    def __len__(self) -> int:
        """Number of vectors."""
        return len(self.ids)

    def add(self, ids: Sequence[int], vectors: Vectors) -> None:
        """Add vectors of length 1."""
        if vectors.ndim != 2 or vectors.shape != (len(ids), self.dimension):
            raise ValueError(f"vectors must be ({len(ids)}, {self.dimension}), got {vectors.shape}")
        if not np.isfinite(vectors).all():
            raise ValueError("a vector holds a number that is not finite")
        if len(ids):
            self._flat.add(np.ascontiguousarray(vectors, dtype=np.float32))
            self.ids.extend(ids)

    def search(self, queries: Vectors, k: int) -> list[list[Hit]]:
        """Find the nearest to each query: the most similar first, of equals the one that was there first.

        FAISS gives equals in no useful order and cuts through them, so more are asked for until the last is less
        similar than the last one wanted.
        """
        if queries.ndim != 2 or queries.shape[1] != self.dimension:
            raise ValueError(f"queries must be (n, {self.dimension}), got {queries.shape}")
        if not np.isfinite(queries).all():
            raise ValueError("a query holds a number that is not finite")
        if not self.ids or k < 1 or not len(queries):
            return [[] for _ in range(len(queries))]
        wanted = min(k + _SPARE, len(self.ids))
        while True:
            scores, rows = self._flat.search(np.ascontiguousarray(queries, dtype=np.float32), wanted)
            rounded = np.round(scores.astype(np.float64), _DIGITS) + 0.0
            if wanted == len(self.ids) or (rounded[:, -1] < rounded[:, min(k, wanted) - 1]).all():
                break
            wanted = min(4 * wanted, len(self.ids))
        return [self._ranked(r, s, k) for r, s in zip(rows, rounded, strict=True)]

    def _ranked(self, rows: NDArray[np.int64], scores: NDArray[np.float64], k: int) -> list[Hit]:
        ranked = sorted(zip((-scores).tolist(), (self.ids[row] for row in rows.tolist()), strict=True))
        return [(number, min(-score, 1.0)) for score, number in ranked[:k]]
