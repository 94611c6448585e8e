"""Judges that know what drivers did who were met here before, in like cases, and one that goes by nothing else."""

from collections.abc import Sequence

from codriving.datatypes import UNCLEAR, CaseMemory, Judgement, Judgements, MetDriver
from codriving.errors import require
from codriving.geometry import RoadMap
from codriving.judgement.contests import Contest
from codriving.judgement.judge import Asked, Judge, said, thresholds
from codriving.judgement.like_cases import CaseObserver, Count, LikeCases
from codriving.reasoning import Moment


class Remembering(Judge):
    """A judge that may be given a memory, which keeps what drivers do in the episodes in which it learns."""

    fewest: int  # Drivers who have to have been met in like cases
    memory: CaseMemory | None = None

    def remember(self, memory: CaseMemory) -> None:
        self.memory = memory

    def reset(self, road_map: RoadMap, model: Asked | None) -> None:
        self._observer = CaseObserver(road_map) if self.memory is not None and self.memory.learns else None
        self._cases = LikeCases(() if self.memory is None else self.memory.encounters(), self.fewest)

    def watch(self, moment: Moment) -> None:
        if self._observer is not None:
            self._observer.watch(moment)

    def encounters(self) -> Sequence[MetDriver]:
        return () if self._observer is None else self._observer.found

    def met(self, asked: Sequence[Contest]) -> list[Count | None]:
        """Return what is remembered of like cases, of each pair that is judged, and see what the drivers do."""
        if self._observer is not None:
            self._observer.note(asked)
        return [self._cases.of(contest) for contest in asked]


class Remembered(Remembering):
    """Relies on drivers as far as those did who were met before; where few were, the rules of the road hold.

    While the memory learns the rules of the road drive, so that what is learnt does not make itself true: of a CAV that
    waits for drivers who push in, all drivers push in.

    Args:
        fewest: Drivers who have to have been met in like cases.
        yields_above: Share of them above which the answer is ``yields``.
        goes_below: Share of them below which it is ``goes``; between both it is ``unclear``.
    """

    name, recalls = "remembered", True

    def __init__(self, fewest: int, yields_above: float, goes_below: float) -> None:
        require(1 <= fewest <= 1000, f"fewest must be 1 to 1000, got {fewest}")
        self.fewest, self.thresholds = fewest, thresholds(yields_above, goes_below)

    def remember(self, memory: CaseMemory) -> None:
        super().remember(memory)
        self.drives = not memory.learns

    def judge(self, asked: Sequence[Contest]) -> Judgements:
        counts = zip(asked, self.met(asked), strict=True)
        return {(contest.cav, contest.human): self._judged(count) for contest, count in counts}

    def _judged(self, count: Count | None) -> Judgement:
        if count is None:
            return Judgement(0.5, UNCLEAR, "few drivers were met in a like case")
        return said(round(count.share, 6), count.words, *self.thresholds)
