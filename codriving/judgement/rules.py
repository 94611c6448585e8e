"""Judges that are one rule each, and the control that is told how every driver drives."""

from collections.abc import Mapping, Sequence

from codriving.datatypes import UNCLEAR, Judgement, Judgements, Manner
from codriving.errors import require_range
from codriving.geometry import RoadMap
from codriving.judgement.contests import Contest
from codriving.judgement.judge import Asked, Judge, said
from codriving.reasoning import known_to_give_way


class RulesNoted(Judge):
    """The rules of the road, noted so that they are measured as the others are."""

    name, drives = "rules_noted", False

    def judge(self, asked: Sequence[Contest]) -> Judgements:
        return {(c.cav, c.human): said(float(bool(c.rule)), c.rule or "no rule of the road holds it up") for c in asked}


class Earliest(Judge):
    """A driver lets pass who would be at the zone clearly later than the CAV, or has been standing for a while.

    Args:
        lead: By how much later it has to be there at its present speed than the CAV at its earliest [s].
        standing: How long it has to have been standing [s].
        against_priority: Whether a driver is relied on who has the right of way; if not, the rules of the road hold.
    """

    name = "earliest"

    def __init__(self, lead: float, standing: float, against_priority: bool) -> None:
        require_range("lead", lead, -5, 10, " s")
        require_range("standing", standing, 0, 30, " s")
        self.lead, self.standing, self.against_priority = lead, standing, against_priority

    def judge(self, asked: Sequence[Contest]) -> Judgements:
        return {(contest.cav, contest.human): self._judged(contest.numbers) for contest in asked}

    def _judged(self, of: Mapping[str, float]) -> Judgement:
        if of["human_standing"] >= self.standing:
            return said(1.0, f"the human driver has been standing for {of['human_standing']:.1f} s")
        times = f"{of['human_time']:.1f} s at its present speed, the CAV {of['cav_time']:.1f} s at the earliest"
        if of["time_ahead"] <= self.lead:
            return said(0.0, f"the human driver takes {times}")
        if of["priority"] < 0 and not self.against_priority:
            return Judgement(0.5, UNCLEAR, "the human driver would be there later, but has the right of way")
        return said(1.0, f"the human driver would be there later: it takes {times}")


class Same(Judge):
    """Says the same of all drivers."""

    def __init__(self, name: str, yields: bool) -> None:
        self.name, self.yields = name, yields

    def judge(self, asked: Sequence[Contest]) -> Judgements:
        answer = said(float(self.yields), f"every human driver is taken to {'give way' if self.yields else 'go on'}")
        return {(contest.cav, contest.human): answer for contest in asked}


class ToldJudge(Judge):
    """A control that is told how each driver treats the right of way."""

    knows_drivers = True

    def __init__(self, name: str) -> None:
        self.name = name

    def reset(self, road_map: RoadMap, model: Asked | None) -> None:
        self._road_map = road_map
        self._manners: Mapping[str, Manner] = {}

    def be_told(self, manners: Mapping[str, Manner]) -> None:
        self._manners = manners

    def judge(self, asked: Sequence[Contest]) -> Judgements:
        found = {}
        for contest in asked:
            if contest.human in self._manners:
                manner = self._manners[contest.human]
                why = known_to_give_way(contest.conflict, contest.driver, self._road_map, manner)
                found[contest.cav, contest.human] = said(float(bool(why)), why or "it is known not to give way")
        return found
