"""The embedders by name, as ``memory.embedder`` chooses them: numbers, words, or a model behind a server."""

import re
import zlib
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from math import asinh, cos, log, log1p, pi, sin

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes import Action, Description
from codriving.errors import ConfigError

Vectors = NDArray[np.float32]

LITELLM = "litellm"  # The word for an embedding model through LiteLLM


class Embedder:
    """Turns descriptions into vectors; this base class only names an embedder whose vectors are there already.

    Attributes:
        dimension: Length of the vectors; None if that is known only after the first call.
    """

    def __init__(self, name: str, dimension: int | None) -> None:
        self.name, self.dimension = name, dimension
        # Whether the thresholds of the config are meant for its cosines. What is like for one embedding model is not
        # for another: of some, all texts of traffic scenes have a cosine of 0.9.
        self.calibrated = not name.startswith(f"{LITELLM} ")

    def embed(self, descriptions: Sequence[Description]) -> Vectors:
        """Return one vector a description, each of length 1."""
        raise NotImplementedError

    def try_out(self) -> None:
        """Refuse before the first episode what would fail in each: no key, no server, no such model."""
        return None


def unit(vectors: NDArray[np.float64]) -> Vectors:
    """Scale each vector to length 1; zeros stay zeros."""
    norms = np.linalg.norm(vectors, axis=1, keepdims=True)
    scaled: Vectors = (vectors / np.where(norms > 0, norms, 1.0)).astype(np.float32)
    return scaled


@dataclass(frozen=True, slots=True)
class Number:
    """How a number becomes a part of the vector."""

    name: str
    weight: float
    scale: float
    span: float
    turns: tuple[int, ...] = (1,)

    @property
    def width(self) -> int:
        """Places in the vector: two a circle, and one that says that the number is not there."""
        return 2 * len(self.turns) + 1


SHARP = (1, 3)  # Circles of the numbers that matter most

# The numbers of a description that are compared, in the order of their places in the vector.
NUMBERS = (
    Number("dttcp", 3.0, 2.0, 20.0, SHARP),
    Number("later", 3.0, 2.0, 20.0, SHARP),
    Number("my_ttcp", 1.5, 2.0, 30.0, SHARP),
    Number("its_ttcp", 1.5, 2.0, 30.0, SHARP),
    Number("mine", 1.5, 8.0, 80.0, SHARP),
    Number("its", 1.5, 8.0, 80.0, SHARP),
    Number("speed", 2.0, 6.0, 30.0, SHARP),
    Number("lead_gap", 2.0, 8.0, 100.0, SHARP),
    Number("target", 0.5, 6.0, 30.0),
    Number("its_speed", 1.0, 6.0, 30.0),
    Number("free", 1.0, 2.0, 20.0),
    Number("lead_speed", 1.0, 6.0, 30.0),
    Number("rear_gap", 0.5, 8.0, 100.0),
    Number("near_ahead", 1.0, 8.0, 100.0),
    Number("near_right", 1.0, 8.0, 100.0),
    Number("near_speed", 0.5, 6.0, 30.0),
    Number("left_ahead", 1.0, 8.0, 100.0),
    Number("left_behind", 1.0, 8.0, 100.0),
    Number("right_ahead", 1.0, 8.0, 100.0),
    Number("right_behind", 1.0, 8.0, 100.0),
    Number("room", 1.0, 20.0, 200.0),
    Number("before", 1.0, 1.0, 6.0),
)

# The kinds of a description, their weights and their words.
KINDS: tuple[tuple[str, float, tuple[str, ...]], ...] = (
    ("relation", 3.0, ("none", "crossing", "converging", "weaving", "diverging", "following")),
    ("order", 3.0, ("none", "first", "second")),
    ("severity", 1.0, ("none", "serious danger", "general danger", "slight danger", "no danger")),
    ("driver", 1.0, ("CAV", "human", "unknown")),
)

# What may be allowed, of the five actions of the paper, and the weight of that.
ACTIONS, ALLOWED = tuple(str(action) for action in Action if action is not Action.HOLD), 1.0

# Share of its weight with which a number counts where it is not there: two empty lanes are alike, but not very.
ABSENT = 0.2


class FeatureEmbedder(Embedder):
    """Works offline, without a download, and gives the same vectors on every call.

    A number x becomes cos and sin of k pi u(x) / 2 for each k of its circles, where u runs from -1 to 1 over its span,
    linear near zero and logarithmic beyond (asinh). Two values have the cosine of their distance, so that the
    similarity of two situations is the weighted mean of the likeness of their parts. A number that is not there lies on
    an axis of its own.
    """

    def __init__(self) -> None:
        places = sum(number.width for number in NUMBERS) + sum(len(words) for _, _, words in KINDS) + len(ACTIONS)
        super().__init__("features-1", places)

    def embed(self, descriptions: Sequence[Description]) -> Vectors:
        rows = np.zeros((len(descriptions), self.dimension or 0))
        for row, description in zip(rows, descriptions, strict=True):
            place = 0
            for number in NUMBERS:
                _put(row[place : place + number.width], number, description.numbers.get(number.name))
                place += number.width
            for name, weight, words in KINDS:
                word = description.kinds.get(name)
                if word in words:
                    row[place + words.index(word)] = weight**0.5
                place += len(words)
            allowed = description.kinds.get("allowed", "").split()
            for k, action in enumerate(ACTIONS):
                row[place + k] = (ALLOWED / len(ACTIONS)) ** 0.5 * (1.0 if action in allowed else -1.0)
        return unit(rows)


def _put(places: NDArray[np.float64], number: Number, value: float | None) -> None:
    if value is None:
        places[-1] = (ABSENT * number.weight) ** 0.5
        return
    u = asinh(min(max(value, -number.span), number.span) / number.scale) / asinh(number.span / number.scale)
    size = (number.weight / len(number.turns)) ** 0.5
    for k, turns in enumerate(number.turns):
        # One quarter turn to either side for the slowest, so that the two ends are opposite.
        angle = turns * pi / 2 * u
        places[2 * k], places[2 * k + 1] = size * cos(angle), size * sin(angle)


DIMENSION = 256

CACHED = 20_000  # Texts whose vectors are remembered

_TOKEN = re.compile(r"-?\d+(?:\.\d+)?|[a-z]+(?:_[a-z]+)*", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class EmbeddingServer:
    """Where an embedding model is."""

    model: str
    api_base: str | None  # Address of the server; None for the provider's own
    api_key_env: str | None  # Name of the environment variable that holds the key; None sends none
    deadline: float  # How long one attempt may take [s]


class WordEmbedder(Embedder):
    """A bag of words and pairs of words, hashed to 256 places (Weinberger et al., 2009, feature hashing)."""

    def __init__(self, banded: bool = True) -> None:
        super().__init__("words-1" if banded else "plain-words-1", DIMENSION)
        self.banded = banded

    def embed(self, descriptions: Sequence[Description]) -> Vectors:
        return self.embed_texts([description.text for description in descriptions])

    def embed_texts(self, texts: Sequence[str]) -> Vectors:
        """Return one vector a text, each of length 1; a text without words gives zeros."""
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
        band = 0 if abs(value) < 1 else 1 + int(log(min(abs(value), 1e300), 2))
        return f"#{'-' if value < 0 else ''}{band}"


class ModelEmbedder(Embedder):
    """An embedding model through LiteLLM; a description's text goes to the server, each text once a process."""

    def __init__(self, server: EmbeddingServer) -> None:
        # What a server needs is imported only where there is one.
        from codriving.llm import EmbeddingModel

        super().__init__(f"{LITELLM} {server.model}", None)
        self._server = server
        self._model = EmbeddingModel(server.model, server.api_base, server.api_key_env, server.deadline)
        self._known: dict[str, list[float]] = {}

    def try_out(self) -> None:
        """Embed one short text, once a process, so that the length of the vectors is known."""
        self.dimension = _dimension(self._server)

    def embed(self, descriptions: Sequence[Description]) -> Vectors:
        """Return one vector a description, each of length 1."""
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


@lru_cache(maxsize=8)
def _dimension(server: EmbeddingServer) -> int:
    """Ask a server for one vector; what fails is asked again the next time."""
    from codriving.llm import EmbeddingModel

    model = EmbeddingModel(server.model, server.api_base, server.api_key_env, server.deadline)
    return len(model.try_out("A vehicle waits.")[0])


# Embedders that need nothing else.
OWN: dict[str, Callable[[], Embedder]] = {"features": FeatureEmbedder, "words": WordEmbedder}


def make_embedder(name: str, server: EmbeddingServer) -> Embedder:
    """Make an embedder."""
    if name in OWN:
        return OWN[name]()
    if name != LITELLM:
        raise ConfigError(f"embedder must be one of {', '.join([*OWN, LITELLM])}, got {name!r}")
    return ModelEmbedder(server)
