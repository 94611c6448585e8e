"""What a model is told of human drivers whose ways meet those of CAVs, and the form of its answer."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Annotated, Any, ClassVar

from pydantic import BaseModel, BeforeValidator, WithJsonSchema, create_model, model_validator

from codriving.llm.prompts.free_text import the_one_of
from codriving.llm.prompts.replies import Reason

# What a word in the place of a probability is taken for.
WORDS = {"yields": 0.9, "yes": 0.9, "goes": 0.1, "no": 0.1, "unclear": 0.5}


@dataclass(frozen=True, slots=True)
class ContestView:
    """A CAV and a human driver who both can still be first; ``name`` is ``p1``, ``p2``, ..."""

    name: str
    cav: str
    human: str
    numbers: Mapping[str, float]
    rule: str  # Why the driver has to let the CAV pass by the rules of the road; empty if it need not
    follows: str  # The vehicle next ahead of the driver; empty if there is none near
    seen: str = ""  # What drivers did in like cases who were met before; empty where that is not known


class JudgementReply(BaseModel):
    """The probability that each driver lets the CAV pass: a key for each pair; a pair may be missing."""

    pairs: ClassVar[tuple[str, ...]]

    reason: Reason = ""

    @model_validator(mode="before")
    @classmethod
    def _given(cls, told: Any) -> dict[str, Any]:  # noqa: ANN401 - anything that the model put there
        """Take what can be used: pairs that exist, each with one probability."""
        if not isinstance(told, dict):
            return {}
        found: dict[str, Any] = {"reason": told.get("reason")}
        for key, value in told.items():
            name = the_one_of(key, cls.pairs)
            if isinstance(value, dict):
                value = next((value[k] for k in ("yields", "probability", "p") if k in value), None)
            if name is not None and (chance := _probability(value)) is not None:
                found[name] = chance
        return found


def _probability(value: Any) -> float | None:  # noqa: ANN401 - anything that the model put there
    """Read a number, a text of one, per cent or a word; None if it is no probability."""
    if isinstance(value, bool):
        return WORDS["yes" if value else "no"]
    if isinstance(value, str):
        text = value.strip().lower()
        if text in WORDS:
            return WORDS[text]
        try:
            value = float(text.rstrip("%")) / (100 if text.endswith("%") else 1)
        except ValueError:
            return None
    return float(value) if isinstance(value, int | float) and 0 <= value <= 1 else None


Chance = Annotated[
    float | None, BeforeValidator(_probability), WithJsonSchema({"type": "number", "minimum": 0, "maximum": 1})
]


def judgement_reply(pairs: Sequence[str]) -> type[JudgementReply]:
    """Return the form of an answer for some pairs."""
    return _judgement_reply(tuple(pairs))


@lru_cache(maxsize=64)
def _judgement_reply(pairs: tuple[str, ...]) -> type[JudgementReply]:
    fields: dict[str, Any] = dict.fromkeys(pairs, (Chance, None))
    made = create_model("Judgements", __base__=JudgementReply, **fields)
    made.pairs = pairs
    return made


def chances(reply: JudgementReply) -> dict[str, float]:
    """Return the probability for each pair that was judged."""
    found = {name: getattr(reply, name) for name in reply.pairs}
    return {name: chance for name, chance in found.items() if chance is not None}
