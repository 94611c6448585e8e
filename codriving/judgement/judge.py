"""The port: what is asked about human drivers, and how a method asks."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from math import isfinite
from pathlib import Path
from typing import Any, TypeAlias

from codriving.datatypes import (
    GOES,
    UNCLEAR,
    YIELDS,
    CaseMemory,
    Conflict,
    HumanJudge,
    Judgement,
    Judgements,
    Manner,
    MetDriver,
    Method,
    Road,
    TrackedVehicle,
    WorldState,
)
from codriving.errors import require, require_range
from codriving.geometry import RoadMap
from codriving.judgement.contests import Contest, contests
from codriving.reasoning import GivesWay, Moment, Perception

# A language model with its templates and its ledger: ``codriving.methods.language_model.prompted_model.PromptedModel``.
Asked: TypeAlias = Any


class Judge(HumanJudge, ABC):
    """Says of human drivers whether they would let a CAV pass if that one goes on now."""

    name: str  # In tables
    knows_drivers = False  # Whether it is told what no vehicle can know
    asks_model = False  # Whether it asks the language model of the method
    recalls = False  # Whether it goes by what the memory of the method holds of human drivers
    drives = True  # Whether its answers are relied on; if not, they are noted and the rules of the road drive

    def reset(self, road_map: RoadMap, model: Asked | None) -> None:
        """Begin an episode.

        Args:
            model: The language model that the method asks; None if it asks none.
        """
        return None

    def be_told(self, manners: Mapping[str, Manner]) -> None:
        """Hear how human drivers treat the right of way; only if ``knows_drivers``."""
        return None

    def remember(self, memory: CaseMemory) -> None:
        """Take the memory of the method; only if it has one."""
        return None

    def watch(self, moment: Moment) -> None:
        """See what the CAVs know at a step, before anything is judged in it."""
        return None

    def encounters(self) -> Sequence[MetDriver]:
        """Return what drivers did in the episode, to be remembered."""
        return ()

    def files(self) -> Mapping[str, Path]:
        """Return the files whose content decides what it says, by what they are."""
        return {}

    @abstractmethod
    def judge(self, asked: Sequence[Contest]) -> Judgements:
        """Answer all pairs of a step at once, by CAV and human driver; a pair may be left out."""


def said(yields: float, reason: str, above: float = 0.5, below: float = 0.5) -> Judgement:
    """Make a judgement of a probability: ``yields`` above one threshold, ``goes`` below another."""
    return Judgement(yields, YIELDS if yields > above else GOES if yields < below else UNCLEAR, reason)


def thresholds(above: float, below: float) -> tuple[float, float]:
    """Check the two thresholds of ``said`` that a user has set."""
    require_range("yields_above", above, 0, 1)
    require_range("goes_below", below, 0, 1)
    require(below <= above, f"goes_below must be at most yields_above, got {below}, {above}")
    return above, below


@dataclass(slots=True)
class JudgedPerception(Perception):
    """What CAVs perceive, with what a judge says of the human drivers in it."""

    judge: Judge | None = None

    def perceive(self, world: WorldState) -> Moment:
        """Return what every CAV knows, with what is expected of human drivers."""
        moment = Perception.perceive(self, world)
        if self.judge is None:
            return moment
        self.judge.watch(moment)
        asked = contests(moment)
        if not asked:
            return moment
        answers = self.judge.judge(asked)
        pairs = [(contest.cav, contest.human) for contest in asked]
        found = {pair: answers[pair] for pair in pairs if pair in answers and is_valid(answers[pair])}
        relied_on = relying_on(found, moment.gives_way) if self.judge.drives else moment.gives_way
        return replace(moment, gives_way=relied_on, judgements=found)


def is_valid(judgement: Judgement) -> bool:
    """Whether a judgement can be used; without one it is the rules of the road that say what is expected."""
    return judgement.answer in (YIELDS, GOES, UNCLEAR) and isfinite(p := judgement.yields) and 0 <= p <= 1


def relying_on(judgements: Judgements, rule: GivesWay) -> GivesWay:
    """Return what says why a driver is expected to let a CAV pass: what was judged, and else the rules of the road.

    A driver who is in the zone has to leave it, whatever was said of the zones behind.
    """

    def gives_way(c: Conflict, human: TrackedVehicle, road_map: RoadMap) -> str:
        judged = judgements.get((c.ego, c.other))
        if judged is None or judged.answer == UNCLEAR or c.distances[1] <= 0:
            return rule(c, human, road_map)
        return judged.reason if judged.answer == YIELDS else ""

    return gives_way


class Judging(Method):
    """A method that asks a judge of human drivers, if one is chosen."""

    judge: Judge | None = None

    def rely_on(self, judge: HumanJudge | None, asks_model: bool = False, memory: CaseMemory | None = None) -> None:
        """Take a judge, but none that asks a model or recalls where the method does not; it shows in the variant."""
        if not isinstance(judge, Judge) or (judge.asks_model and not asks_model) or (judge.recalls and memory is None):
            return
        if memory is not None:
            judge.remember(memory)
        self.judge, self.knows_drivers = judge, self.knows_drivers or judge.knows_drivers
        words = ["" if self.variant == "full" else self.variant, f"judgement={judge.name}"]
        self.variant = "/".join(word for word in words if word)

    def judged(self, perception: Perception, model: Asked | None = None) -> Perception:
        """Let the judge say what is expected of the human drivers that are perceived, from now on."""
        if self.judge is None:
            return perception
        self.judge.reset(perception.road_map, model)
        values: dict[str, Any] = {field.name: getattr(perception, field.name) for field in fields(Perception)}
        return JudgedPerception(**values, judge=self.judge)

    def files(self, road: Road, limited: bool) -> Mapping[str, Path]:
        return {**super().files(road, limited), **(self.judge.files() if self.judge is not None else {})}

    def be_told(self, manners: Mapping[str, Manner]) -> None:
        super().be_told(manners)
        if self.judge is not None:
            self.judge.be_told(manners)


def judgements_of(moment: Moment, ego: str) -> dict[str, Judgement]:
    """Return what one CAV relies on, by human driver."""
    return {human: judged for (cav, human), judged in moment.judgements.items() if cav == ego}
