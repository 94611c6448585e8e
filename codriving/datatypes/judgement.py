"""What is expected of a human driver whose way a CAV's shares a zone with."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, Literal

from codriving.datatypes.order import Pair

Expectation = Literal["yields", "goes", "unclear"]

YIELDS: Final = "yields"
GOES: Final = "goes"
UNCLEAR: Final = "unclear"


@dataclass(frozen=True, slots=True)
class Judgement:
    """Whether a human driver would let a CAV pass if that one goes on now."""

    yields: float  # Probability that it lets the CAV pass
    answer: Expectation  # ``unclear`` leaves it to the rules of the road
    reason: str


Judgements = Mapping[Pair, Judgement]  # By CAV and human driver


@dataclass(frozen=True, slots=True)
class MetDriver:
    """A CAV and a human driver of whom it was open who goes first, and who then did."""

    cav: str
    human: str
    step: int  # Which time at which pairs were judged in the episode this was
    numbers: Mapping[str, float]  # What was known of both, by name
    relied: bool  # Whether the rules of the road let the CAV rely on the driver
    yielded: bool  # Whether the driver let the CAV pass
