"""A judge that goes by what drivers did who were met here before, in like cases."""

from collections.abc import Sequence

from codriving.datatypes import UNCLEAR, CaseMemory, Encounter, Judgement, Judgements
from codriving.errors import require
from codriving.geometry import RoadMap
from codriving.judgement.contests import Contest
from codriving.judgement.judge import Asked, Judge, said, thresholds
from codriving.judgement.like_cases import LikeCases, Observer
from codriving.reasoning import Moment


class Remembered(Judge):
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
        self._memory, self.drives = memory, not memory.learns

    def reset(self, road_map: RoadMap, model: Asked | None) -> None:
        self._cases, self._observer = LikeCases(self._memory.encounters(), self.fewest), Observer(road_map)

    def watch(self, moment: Moment) -> None:
        self._observer.watch(moment)

    def encounters(self) -> Sequence[Encounter]:
        return self._observer.found

    def judge(self, asked: Sequence[Contest]) -> Judgements:
        self._observer.note(asked)
        return {(contest.cav, contest.human): self._judged(contest) for contest in asked}

    def _judged(self, contest: Contest) -> Judgement:
        count = self._cases.of(contest)
        if count is None:
            return Judgement(0.5, UNCLEAR, "few drivers were met in a like case")
        told = f"{count.yielded} of {count.all} drivers met in like cases let the CAV pass"
        return said(round(count.share, 6), told, *self.thresholds)
