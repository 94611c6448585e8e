"""The port through which decisions are made; rules and language models stand behind it alike."""

from collections.abc import Sequence
from typing import Protocol

from codriving.datatypes.situation import Decision, Situation


class Decider(Protocol):
    """Decides for all vehicles in one call."""

    def decide(self, situations: Sequence[Situation]) -> list[Decision]:
        """Return one decision a situation, in the same order."""
        ...
