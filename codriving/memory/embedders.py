"""The embedders by name, as ``memory.embedder`` chooses them: numbers, words, or a model behind a server."""

import re
import zlib
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import log, log1p

import numpy as np

from codriving.datatypes.experience import Description
from codriving.errors import ConfigError
from codriving.memory.embedder import Embedder, Vectors, unit
from codriving.memory.features import FeatureEmbedder

DIMENSION = 256

LITELLM = "litellm"
"""The word for an embedding model through LiteLLM."""

CACHED = 20_000
"""Texts whose vectors are remembered."""

_TOKEN = re.compile(r"-?\d+(?:\.\d+)?|[a-z]+(?:_[a-z]+)*", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class EmbeddingServer:
    """Where an embedding model is.

    Attributes:
        api_base: Address of the server; None for the provider's own.
        api_key_env: Name of the environment variable that holds the key; None sends none.
        deadline: How long one attempt may take [s].
    """

    model: str
    api_base: str | None
    api_key_env: str | None
    deadline: float


class WordEmbedder(Embedder):
    """A bag of words and pairs of words, hashed to 256 places (Weinberger et al., 2009, feature hashing)."""

    def __init__(self, banded: bool = True) -> None:
        super().__init__("words-1" if banded else "plain-words-1", DIMENSION)
        self.banded = banded

    def embed(self, descriptions: Sequence[Description]) -> Vectors:
        return self.embed_texts([description.text for description in descriptions])

    def embed_texts(self, texts: Sequence[str]) -> Vectors:
        """Return one vector a text, each of length 1; a text without words gives zeros.

        Returns:
            Vectors (n, 256).
        """
        rows = np.zeros((len(texts), DIMENSION))
        for row, text in zip(rows, texts, strict=True):
            for term, count in Counter(self._terms(text)).items():
                code = zlib.crc32(term.encode())
                row[code % DIMENSION] += log1p(count) * (1.0 if code >> 31 else -1.0)
        return unit(rows)

    def _terms(self, text: str) -> Iterator[str]:
        words = [self._word(token) for token in _TOKEN.findall(text.lower())]
        yield from words
        yield from (f"{one} {other}" for one, other in pairwise(words))

    def _word(self, token: str) -> str:
        if not self.banded or not (token[0].isdigit() or token[0] == "-"):
            return token
        value = float(token)
        # Bands grow with the number: 0, 1, 2 to 3, 4 to 7, ...
        band = 0 if abs(value) < 1 else 1 + int(log(abs(value), 2))
        return f"#{'-' if value < 0 else ''}{band}"


class ModelEmbedder(Embedder):
    """An embedding model through LiteLLM; a description's text goes to the server, each text once a process.

    Raises:
        ConfigError: If a setting breaks its rule.
    """

    def __init__(self, server: EmbeddingServer) -> None:
        # What a server needs is imported only where there is one.
        from codriving.llm.embeddings import EmbeddingModel

        super().__init__(f"{LITELLM} {server.model}", None)
        self._model = EmbeddingModel(server.model, server.api_base, server.api_key_env, server.deadline)
        self._known: dict[str, list[float]] = {}

    def embed(self, descriptions: Sequence[Description]) -> Vectors:
        """Return one vector a description, each of length 1.

        Raises:
            ModelUnavailableError: If the server does not answer, retries included.
            ModelError: If it must be mended: no key, no such model, vectors of different lengths.
        """
        texts = [description.text for description in descriptions]
        new = list(dict.fromkeys(text for text in texts if text not in self._known))
        if new:
            if len(self._known) + len(new) > CACHED:
                self._known.clear()
                new = list(dict.fromkeys(texts))
            for text, vector in zip(new, self._model.embed(new), strict=True):
                self._known[text] = vector
                self.dimension = len(vector)
        if not texts:
            return np.zeros((0, self.dimension or 1), dtype=np.float32)
        return unit(np.array([self._known[text] for text in texts], dtype=np.float64))


OWN: dict[str, Callable[[], Embedder]] = {"features": FeatureEmbedder, "words": WordEmbedder}
"""Embedders that need nothing else."""


def make_embedder(name: str, server: EmbeddingServer) -> Embedder:
    """Make an embedder.

    Args:
        name: ``features``, ``words`` or ``litellm``.
        server: Where the model is, for ``litellm``.

    Raises:
        ConfigError: If there is no such embedder, or the server's settings cannot be used.
    """
    if name in OWN:
        return OWN[name]()
    if name != LITELLM:
        raise ConfigError(f"embedder must be one of {', '.join([*OWN, LITELLM])}, got {name!r}")
    return ModelEmbedder(server)
