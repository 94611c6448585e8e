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
