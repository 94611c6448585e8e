"""What an embedder is: descriptions to vectors whose cosine tells how similar two situations are."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes.experience import Description

Vectors = NDArray[np.float32]


class Embedder:
    """Turns descriptions into vectors; this base class only names an embedder whose vectors are there already.

    Attributes:
        dimension: Length of the vectors; None if that is known only after the first call.
    """

    def __init__(self, name: str, dimension: int | None) -> None:
        self.name, self.dimension = name, dimension

    def embed(self, descriptions: Sequence[Description]) -> Vectors:
        """Return one vector a description, each of length 1.

        Returns:
            Vectors (n, dimension); a description without anything to go by gives zeros.
        """
        raise NotImplementedError


def unit(vectors: NDArray[np.float64]) -> Vectors:
    """Scale each vector to length 1; zeros stay zeros.

    Args:
        vectors: Vectors (n, dimension).
    """
    norms = np.linalg.norm(vectors, axis=1, keepdims=True)
    scaled: Vectors = (vectors / np.where(norms > 0, norms, 1.0)).astype(np.float32)
    return scaled
