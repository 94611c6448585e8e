"""Embedding by words alone: the hashed words of the description, each weighted by how often it stands there."""

import re
import zlib
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import log, log1p

import numpy as np

from codriving.datatypes.experience import Description
from codriving.memory.embedder import Vectors, unit

DIMENSION = 256

_TOKEN = re.compile(r"-?\d+(?:\.\d+)?|[a-z]+(?:_[a-z]+)*", re.IGNORECASE)


class Words:
    """A bag of words and pairs of words, hashed to 256 places (Weinberger et al., 2009, feature hashing)."""

    def __init__(self, banded: bool = True) -> None:
        self.banded = banded
        self.name = "words-1" if banded else "plain-words-1"

    @property
    def dimension(self) -> int:
        """Length of the vectors."""
        return DIMENSION

    def embed(self, descriptions: Sequence[Description]) -> Vectors:
        """Return one vector a description, each of length 1.

        Returns:
            Vectors (n, 256).
        """
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
