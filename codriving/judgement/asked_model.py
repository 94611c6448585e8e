"""A judge that asks the language model of the method: one question a step, for all pairs of all CAVs."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, cast

from codriving.datatypes import Judgements
from codriving.geometry import RoadMap
from codriving.judgement.contests import Contest
from codriving.judgement.judge import Asked, said, thresholds
from codriving.judgement.remembered import Remembering
from codriving.llm import ContestView, JudgementReply, Names, Question, chances, judgement_reply

if TYPE_CHECKING:
    from pydantic import BaseModel

TOKENS_A_PAIR = 10  # What a pair takes in the answer [tokens]

LONGEST_RULE = 160  # Characters of a reason


FEWEST = 5  # Drivers who have to have been met in like cases for the model to be told what they did


class AskedModel(Remembering):
    """Takes probabilities from a language model; what it leaves out is left to the rules of the road.

    With a memory the model is told what drivers did in like cases.

    Args:
        yields_above: Probability above which the answer is ``yields``.
        goes_below: Probability below which it is ``goes``; between both it is ``unclear``.
    """

    name, asks_model, fewest = "llm", True, FEWEST

    def __init__(self, yields_above: float, goes_below: float) -> None:
        self.thresholds = thresholds(yields_above, goes_below)

    def reset(self, road_map: RoadMap, model: Asked | None) -> None:
        super().reset(road_map, model)
        self._model = model

    def judge(self, asked: Sequence[Contest]) -> Judgements:
        if self._model is None:
            return {}
        # The most urgent first: of a question that is too long the second half is left out.
        ordered = sorted(asked, key=lambda c: (c.numbers["cav_time"], c.cav, c.human))
        pairs = {f"p{k + 1}": contest for k, contest in enumerate(ordered)}
        self._seen = {f"p{k + 1}": count.words for k, count in enumerate(self.met(ordered)) if count is not None}
        [answer] = self._model.ask([self._question(pairs)])
        if answer.value is None:
            return {}
        reply = cast(JudgementReply, answer.value)
        found = {}
        for name, chance in chances(reply).items():
            contest = pairs[name]
            why = reply.reason or f"a driver like this lets the CAV pass with {chance:.0%}"
            found[contest.cav, contest.human] = said(chance, f"judged by the model: {why}", *self.thresholds)
        return found

    def _question(self, pairs: dict[str, Contest]) -> Question:
        names = Names([name for c in pairs.values() for name in (c.cav, c.human, c.follows) if name])
        views = [
            ContestView(
                name,
                names(c.cav),
                names(c.human),
                c.numbers,
                names.sentence(c.rule, LONGEST_RULE),
                names(c.follows) if c.follows else "",
                self._seen.get(name, ""),
            )
            for name, c in pairs.items()
        ]

        def check(reply: "BaseModel") -> str:
            wanted = "; ".join(f"{view.name} ({view.human} before {view.cav})" for view in views)
            told = chances(cast(JudgementReply, reply))
            return "" if told else f"no pair was judged; give a number from 0 to 1 for each pair: {wanted}"

        def shorter() -> Question | None:
            half = dict(list(pairs.items())[: len(pairs) // 2])
            return self._question(half) if half else None

        assert self._model is not None
        messages = self._model.prompts.messages("judge", {"pairs": views})
        form = judgement_reply(list(pairs))
        return Question("judge", "", messages, form, check, shorter, TOKENS_A_PAIR * len(pairs))
