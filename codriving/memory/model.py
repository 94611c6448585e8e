"""Embedding by a model: the description's text goes to a server, each text once a process."""

from collections.abc import Sequence

import numpy as np

from codriving.datatypes.experience import Description
from codriving.llm.embeddings import EmbeddingModel
from codriving.memory.embedder import Vectors, unit

KEPT = 20_000
"""Texts whose vectors are remembered."""


class ModelEmbedder:
    """An embedding model through LiteLLM.

    Args:
        api_base: Address of the server; None for the provider's own.
        api_key_env: Name of the environment variable that holds the key; None sends none.
        deadline: How long one attempt may take [s].

    Raises:
        ConfigError: If a setting breaks its rule.
    """

    def __init__(self, model: str, api_base: str | None, api_key_env: str | None, deadline: float) -> None:
        self.name = f"litellm {model}"
        self.dimension: int | None = None
        self._model = EmbeddingModel(model, api_base, api_key_env, deadline)
        self._known: dict[str, list[float]] = {}

    def embed(self, descriptions: Sequence[Description]) -> Vectors:
        """Return one vector a description, each of length 1.

        Returns:
            Vectors (n, dimension).

        Raises:
            ModelUnavailableError: If the server does not answer, retries included.
            ModelError: If it must be mended: no key, no such model, vectors of different lengths.
        """
        texts = [description.text for description in descriptions]
        new = list(dict.fromkeys(text for text in texts if text not in self._known))
        if new:
            if len(self._known) + len(new) > KEPT:
                self._known.clear()
                new = list(dict.fromkeys(texts))
            for text, vector in zip(new, self._model.embed(new), strict=True):
                self._known[text] = vector
                self.dimension = len(vector)
        if not texts:
            return np.zeros((0, self.dimension or 1), dtype=np.float32)
        return unit(np.array([self._known[text] for text in texts], dtype=np.float64))
