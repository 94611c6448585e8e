"""The default embedder: numbers on circles and kinds as axes, so that the cosine measures how far situations differ."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import asinh, cos, pi, sin

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes.experience import Description
from codriving.datatypes.world import Action
from codriving.memory.embedder import Embedder, Vectors, unit


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


SHARP = (1, 3)
"""Circles of the numbers that matter most."""

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
"""The numbers of a description that are compared, in the order of their places in the vector."""

KINDS: tuple[tuple[str, float, tuple[str, ...]], ...] = (
    ("relation", 3.0, ("none", "crossing", "converging", "weaving", "diverging", "following")),
    ("order", 3.0, ("none", "first", "second")),
    ("severity", 1.0, ("none", "serious danger", "general danger", "slight danger", "no danger")),
    ("driver", 1.0, ("CAV", "human", "unknown")),
)
"""The kinds of a description, their weights and their words."""

ACTIONS, ALLOWED = tuple(str(action) for action in Action), 1.0
"""What may be allowed, and the weight of that."""

ABSENT = 0.2
"""Share of its weight with which a number counts where it is not there: two empty lanes are alike, but not very."""


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
                value = description.numbers.get(number.name)
                _put(row[place : place + number.width], number, value)
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
