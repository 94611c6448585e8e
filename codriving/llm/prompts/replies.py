"""The forms of the answers, made for each question: what may be said is part of the form.

They take in a little more than they ask for, so that an answer which only names a vehicle wrongly is not lost as a
whole; the check of each question says what is wrong.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from typing import Annotated, Any, ClassVar

from pydantic import BaseModel, BeforeValidator, Field, WithJsonSchema, create_model, model_validator

from codriving.datatypes import Action
from codriving.llm.prompts.free_text import one_line, the_one_of


def _short(value: Any) -> str:  # noqa: ANN401 - anything that the model put there
    if isinstance(value, list):
        value = "; ".join(text for text in value if isinstance(text, str))
    return one_line(value) if isinstance(value, str) else ""


def _action(value: Any) -> Any:  # noqa: ANN401 - anything that the model put there
    """Call an action by its name, also one that is not allowed now: the model is told why not."""
    return the_one_of(value, map(str, Action)) or value.strip().upper() if isinstance(value, str) else value


def _one_of(words: Sequence[str]) -> Any:  # noqa: ANN401 - pydantic's own type is not public
    """Ask for one of some words; that it is one of them is checked later, see above."""
    return Field(json_schema_extra={"enum": list(words)})


def _one_word(words: Sequence[str]) -> WithJsonSchema:
    """Ask for one of some words where more is read."""
    return WithJsonSchema({"enum": list(words), "type": "string"})


# A reason: on one line, and capped; a model may write a little more than is kept, rather than in the middle of a word.
Reason = Annotated[str, BeforeValidator(_short), WithJsonSchema({"type": "string", "maxLength": 240})]

ActionWord = Annotated[str, BeforeValidator(_action)]


def _thought(value: Any) -> str:  # noqa: ANN401 - anything that the model put there
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        value = " ".join(text for text in value if isinstance(text, str))
    return one_line(value, LONGEST_THOUGHTS) if isinstance(value, str) else ""


LONGEST_THOUGHTS = 600  # Characters of the thoughts that are kept


class ThoughtfulReply(BaseModel):
    """Thoughts, before anything else: in one text, or point by point."""

    thoughts: Annotated[str, BeforeValidator(_thought), WithJsonSchema({"type": "string", "maxLength": 900})] = ""


class DecisionReply(BaseModel):
    """A decision: the reason first, since what is written first shapes what follows."""

    reason: Reason = ""
    action: str


class PairReply(BaseModel):
    """Which vehicle goes first in one pair."""

    first: str
    reason: Reason = ""


class OrderReply(BaseModel):
    """Which vehicle goes first in every pair: a key for each pair; a pair may be missing.

    The form of version 0.1, a list of pairs below the key ``orders``, is read, too.
    """

    pairs: ClassVar[Mapping[str, tuple[str, str]]]
    older_keys: ClassVar[tuple[str, ...]] = ("orders",)

    reason: Reason = ""

    @model_validator(mode="before")
    @classmethod
    def _listed(cls, said: Any) -> dict[str, Any]:  # noqa: ANN401 - anything that the model put there
        """Take what can be used: pairs that exist, of which one of the two goes first, and always the same."""
        of = {key: said.get(key) for key in ("thoughts", "reason")} if isinstance(said, dict) else {}
        found: dict[str, dict[str, Any]] = {}
        torn: set[str] = set()
        # One pair alone is part of an order; it counts in a list.
        alone = isinstance(said, dict) and "pair" in said
        for pair, first, reason in () if alone else _entries(said):
            name = the_one_of(pair, cls.pairs)
            goes = None if name is None else the_one_of(first, cls.pairs[name])
            if name is None or goes is None:
                continue
            if found.setdefault(name, {"first": goes, "reason": reason})["first"] != goes:
                torn.add(name)
        return {**of, **{name: pair for name, pair in found.items() if name not in torn}}


def _entries(said: Any) -> Iterator[tuple[Any, Any, Any]]:  # noqa: ANN401 - anything that the model put there
    """Give pair, vehicle and reason of each entry of an order, in whichever of its forms."""
    if isinstance(said, list):
        for entry in said:
            yield from _entries(entry)
    if not isinstance(said, dict):
        return
    keys = {the_one_of(key, ("orders", "pair", "first", "reason")) or key: value for key, value in said.items()}
    if "orders" in keys:
        yield from _entries(keys["orders"])
    elif "pair" in keys:
        yield keys["pair"], keys.get("first"), keys.get("reason")
    else:
        for pair, value in said.items():
            [(_, first, reason)] = (
                _entries({**value, "pair": pair}) if isinstance(value, dict) else [(pair, value, None)]
            )
            yield pair, first, reason


class LessonReply(BaseModel):
    """What is to be learnt from one decision."""

    lesson: Reason = ""


class CorrectionReply(BaseModel):
    """A correction: the mistake first, since what is written first shapes what follows."""

    mistake: Reason = ""
    lesson: Reason = ""
    action: str


@lru_cache(maxsize=64)
def decision_reply(allowed: tuple[str, ...], thoughts: bool = False, plan: bool = False) -> type[DecisionReply]:
    """Return the form of a decision, with thoughts before it and a plan after it if they are asked for."""
    fields: dict[str, Any] = {"action": (ActionWord, _one_of(allowed))} | ({"plan": (Reason, "")} if plan else {})
    bases: Any = (DecisionReply, ThoughtfulReply) if thoughts else DecisionReply
    made: type[DecisionReply] = create_model("Decision", __base__=bases, **fields)
    return made


@lru_cache(maxsize=64)
def correction_reply(allowed: tuple[str, ...]) -> type[CorrectionReply]:
    """Return the form of a correction."""
    return create_model("Reflection", __base__=CorrectionReply, action=(ActionWord, _one_of(allowed)))


def order_reply(pairs: Mapping[str, tuple[str, str]], thoughts: bool = False) -> type[OrderReply]:
    """Return the form of a passing order, with thoughts before it if they are asked for."""
    return _order_reply(tuple(pairs.items()), thoughts)


def pair_names(pairs: Sequence[tuple[str, str]], lasting: bool) -> list[str]:
    """Name pairs after their vehicles, so that a name means the same in the next question; else ``p1``, ``p2``, ..."""
    named = [f"{one}_{other}" for one, other in pairs]
    plain = all(_PLAIN.fullmatch(name) and not hasattr(OrderReply, name) for name in named)
    return named if lasting and plain else [f"p{k + 1}" for k in range(len(pairs))]


_PLAIN = re.compile(r"[A-Za-z0-9][\w.-]{0,63}", re.ASCII)  # What servers take as a key


@lru_cache(maxsize=64)
def _order_reply(pairs: tuple[tuple[str, tuple[str, str]], ...], thoughts: bool) -> type[OrderReply]:
    fields: dict[str, Any] = {name: (Annotated[PairReply | None, _one_word(both)], None) for name, both in pairs}
    bases: Any = (OrderReply, ThoughtfulReply) if thoughts else OrderReply
    made: type[OrderReply] = create_model("Order", __base__=bases, **fields)
    made.pairs = dict(pairs)
    return made


def first_of_pairs(reply: OrderReply) -> dict[str, tuple[str, str]]:
    """Return which vehicle goes first and why, by the name of each pair that was ordered."""
    found = {name: getattr(reply, name) for name in reply.pairs}
    return {name: (pair.first, pair.reason or reply.reason) for name, pair in found.items() if pair is not None}
