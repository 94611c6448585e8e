"""What a method needs of a memory; anything of this shape can be put into the slot."""

from collections.abc import Sequence
from typing import Protocol

from codriving.datatypes.experience import Experience, Interaction, Memory
from codriving.datatypes.situation import Situation


class CaseMemory(Protocol):
    """Recalls what is like a situation, and may learn from what comes of the decisions.

    Attributes:
        label: What tables say of it.
        learns: Whether what it is given is kept.
        reflections: Mistakes of an episode that a model is asked about at most; 0 asks none.
    """

    label: str
    learns: bool
    reflections: int

    def begin(self, seed: int) -> None:
        """Begin an episode.

        Args:
            seed: Its seed.
        """
        ...

    def recall(self, situations: Sequence[Situation]) -> list[tuple[Memory, ...]]:
        """Find what is like each situation, most similar first.

        Args:
            situations: What each CAV is told.
        """
        ...

    def learn(self, interaction: Interaction, experiences: Sequence[Experience]) -> int:
        """Keep what was learnt in an episode.

        Args:
            interaction: The episode.
            experiences: What is worth keeping of it.

        Returns:
            How many were new.
        """
        ...
