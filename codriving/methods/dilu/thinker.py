"""The port through which DiLu reasons; the rule and language models stand behind it alike."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from codriving.datatypes.situation import Decision, Situation
from codriving.methods.dilu.told import Told


@dataclass(frozen=True, slots=True)
class Thought:
    """What one CAV decides."""

    decision: Decision
    situation: Situation
    counts: Mapping[str, int] = field(default_factory=dict)


class Thinker(Protocol):
    """Decides for all CAVs in one call, each by what it alone is told."""

    def decide(self, told: Sequence[Told]) -> list[Thought]:
        """Return one thought a CAV, in the same order."""
        ...
