"""The forms of the answers, made for each question: what may be said is part of the form.

They take in a little more than they ask for, so that an answer which only names a vehicle wrongly is not lost as a
whole; the check of each question says what is wrong.
"""

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Annotated, Any

from pydantic import BaseModel, BeforeValidator, Field, create_model

from codriving.llm.prompts.free_text import one_line


def _short(value: Any) -> Any:  # noqa: ANN401 - anything that the model put there
    return one_line(value) if isinstance(value, str) else "" if value is None else value


def _upper(value: Any) -> Any:  # noqa: ANN401 - anything that the model put there
    return value.strip().upper() if isinstance(value, str) else value


def _one_of(words: Sequence[str]) -> Any:  # noqa: ANN401 - pydantic's own type is not public
    """Ask for one of some words; that it is one of them is checked later, see above."""
    return Field(json_schema_extra={"enum": list(words)})


Reason = Annotated[str, BeforeValidator(_short)]  # A reason: on one line, and capped

ActionWord = Annotated[str, BeforeValidator(_upper)]


class DecisionReply(BaseModel):
    """A decision: the reason first, since what is written first shapes what follows."""

    reason: Reason = ""
    action: str


class PairReply(BaseModel):
    """Which vehicle goes first in one pair."""

    pair: str
    first: str
    reason: Reason = ""


class OrderReply(BaseModel):
    """Which vehicle goes first in every pair."""

    orders: Sequence[PairReply]


class LessonReply(BaseModel):
    """What is to be learnt from one decision."""

    lesson: Reason = ""


class CorrectionReply(BaseModel):
    """A correction: the mistake first, since what is written first shapes what follows."""

    mistake: Reason = ""
    lesson: Reason = ""
    action: str


@lru_cache(maxsize=64)
def decision_reply(allowed: tuple[str, ...]) -> type[DecisionReply]:
    """Return the form of a decision."""
    return create_model("Decision", __base__=DecisionReply, action=(ActionWord, _one_of(allowed)))


@lru_cache(maxsize=64)
def correction_reply(allowed: tuple[str, ...]) -> type[CorrectionReply]:
    """Return the form of a correction."""
    return create_model("Reflection", __base__=CorrectionReply, action=(ActionWord, _one_of(allowed)))


def order_reply(pairs: Mapping[str, tuple[str, str]]) -> type[OrderReply]:
    """Return the form of a passing order."""
    vehicles = sorted({name for pair in pairs.values() for name in pair})
    entry = create_model("Pair", __base__=PairReply, pair=(str, _one_of(list(pairs))), first=(str, _one_of(vehicles)))
    return create_model("Order", __base__=OrderReply, orders=(list[entry], ...))  # type: ignore[valid-type]


def first_of_pairs(reply: OrderReply, pairs: Mapping[str, tuple[str, str]]) -> dict[str, tuple[str, str]]:
    """Return what can be used of an order: pairs that exist, of which one of the two goes first.

    A pair that is named twice with different answers is left out.

    Returns:
        Which vehicle goes first and why, by the name of the pair.
    """
    found: dict[str, tuple[str, str]] = {}
    torn: set[str] = set()
    for entry in reply.orders:
        name, first = entry.pair.strip(), entry.first.strip()
        if name not in pairs or first not in pairs[name]:
            continue
        if name in found and found[name][0] != first:
            torn.add(name)
        found.setdefault(name, (first, entry.reason))
    return {name: answer for name, answer in found.items() if name not in torn}
