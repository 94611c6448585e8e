"""What is kept of an episode: one record that every table is made from."""

from dataclasses import dataclass

from codriving.datatypes.outcome import Outcome
from codriving.datatypes.score import Score


@dataclass(frozen=True, slots=True)
class Participant:
    """A vehicle that took part in an episode."""

    id: str
    kind: str  # ``CAV`` or ``HDV``
    route: str
    arrived: float | None  # Time of arrival [s], or None


@dataclass(frozen=True, slots=True)
class EpisodeRecord:
    """The result of one episode; free of anything that depends on the machine or its clock.

    Attributes:
        scores: Its score by the name of the metric; none for ``error``.
    """

    scenario: str
    method: str
    variant: str  # Name of the CDA variant, for instance ``full`` or ``no_negotiation/own_view``
    reasoner: str  # Who reasoned: ``rules`` or the name of a model
    seed: int
    outcome: Outcome
    scores: dict[str, Score]
    participants: tuple[Participant, ...]
    decisions: int
    counts: dict[str, int | float]
    memory: str = ""
