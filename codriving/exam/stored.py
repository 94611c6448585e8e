"""What an exam holds: situations and negotiations, each with what came of every answer when it was driven on."""

from collections.abc import Mapping
from dataclasses import dataclass

from codriving.datatypes import Action, Conflict, Pair, PassingOrder, SceneDescription, Situation
from codriving.judgement import Contest
from codriving.reasoning import Problem

ACCEPTABLE = 0.5  # What an acceptable answer loses at most against the best one [s]
NEAR_MISS = 1.5  # Least PET of an acceptable answer [s]


@dataclass(frozen=True, slots=True)
class Origin:
    """Where a question comes from: the world, as overrides, the episode, the step, and whose knowledge it is."""

    world: str
    overrides: tuple[str, ...]
    seed: int
    step: int
    ego: str  # The CAV that decides; empty of a negotiation


@dataclass(frozen=True, slots=True)
class Consequence:
    """What came of one answer, over all drives."""

    drives: int
    collisions: int  # Drives in which the CAV, or one of the pair, collided or left the road
    near_misses: int  # Drives in which it had a PET below `NEAR_MISS`
    loss: float  # Mean time that all vehicles together lost, against the answer that lost least [s]

    @property
    def safe(self) -> bool:
        """Whether no drive ended badly."""
        return self.collisions == 0

    @property
    def acceptable(self) -> bool:
        """Whether it is safe, without a near miss, and about as fast as the best."""
        return self.safe and self.near_misses == 0 and self.loss <= ACCEPTABLE


@dataclass(frozen=True, slots=True)
class ExamSituation:
    """One decision of one CAV."""

    name: str
    origin: Origin
    situation: Situation
    actions: Mapping[Action, Consequence]  # Of each action that the safety check left
    contests: tuple[Contest, ...]  # Human drivers of whom it is open whether they let the CAV pass
    yields: tuple[bool, ...]  # Whether each did when the CAV went on

    @property
    def best(self) -> Action:
        """The acceptable action that loses least."""
        return min((a for a, c in self.actions.items() if c.acceptable), key=lambda a: (self.actions[a].loss, a))


@dataclass(frozen=True, slots=True)
class PairInQuestion:
    """A pair of CAVs, and what came of either going first."""

    one: str
    other: str
    first: str  # The one that went first by the rules
    if_one: Consequence
    if_other: Consequence

    def consequence(self, first: str) -> Consequence:
        """Return what came of it where one of them went first."""
        return self.if_one if first == self.one else self.if_other


@dataclass(frozen=True, slots=True)
class ExamNegotiation:
    """One negotiation of CAVs in conflict."""

    name: str
    origin: Origin
    scenes: Mapping[str, SceneDescription]
    problem: Problem
    conflicts: tuple[Conflict, ...]  # The most urgent one of each pair that is asked about
    previous: PassingOrder | None  # What was agreed on before
    pairs: tuple[PairInQuestion, ...]  # Those that were judged, by driving on with either first

    def pair(self, asked: Pair) -> PairInQuestion | None:
        """Return a pair that was judged; None for one that was not."""
        return next((p for p in self.pairs if {p.one, p.other} == set(asked)), None)


@dataclass(frozen=True, slots=True)
class StoredExam:
    """All questions, and how they were judged."""

    situations: tuple[ExamSituation, ...]
    negotiations: tuple[ExamNegotiation, ...]
    about: Mapping[str, str]  # Date, version, behaviour number, seeds, and the settings of the judging
    sha256: str = ""  # Of its file; empty before it is written
