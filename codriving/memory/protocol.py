"""What a method needs of a memory; anything of this shape can be put into the slot."""

from collections.abc import Sequence
from typing import Protocol

from codriving.datatypes.experience import Experience, Interaction, Memory
from codriving.datatypes.situation import Situation


class CaseMemory(Protocol):
    """Recalls what is like a situation, and may learn from what comes of the decisions."""

    label: str
    learns: bool
    reflections: int

    def begin(self, seed: int) -> None:
        """Begin an episode."""
        ...

    def recall(self, situations: Sequence[Situation]) -> list[tuple[Memory, ...]]:
        """Find what is like each situation, most similar first."""
        ...

    def learn(self, interaction: Interaction, experiences: Sequence[Experience]) -> int:
        """Keep what was learnt in an episode."""
        ...
