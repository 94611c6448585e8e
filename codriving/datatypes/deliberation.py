"""Everything that was said and decided in one decision step."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass, fields, is_dataclass
from functools import lru_cache
from math import isfinite
from operator import attrgetter
from typing import Any, cast

from codriving.datatypes.action import Action
from codriving.datatypes.order import PassingOrder
from codriving.datatypes.situation import Decision, Situation


class Deliberation(ABC):
    """One decision step of a method.

    Attributes:
        counts: Counters of this step (fallbacks, repaired orders, cost, ...), summed over the episode.
        transcript: What a language model was asked, one line of ``transcript.jsonl`` a question.
    """

    counts: Mapping[str, float]
    transcript: tuple[dict[str, Any], ...] = ()

    @property
    @abstractmethod
    def actions(self) -> dict[str, Action]:
        """The action of each CAV, by id."""

    @abstractmethod
    def as_dict(self) -> dict[str, Any]:
        """Return the step as one JSON-ready line of ``decisions.jsonl``."""


@dataclass(frozen=True, slots=True)
class ReasonedDeliberation(Deliberation):
    """A decision step in which the situation of each CAV is described."""

    time: float  # Simulated time [s]
    step: int
    situations: tuple[Situation, ...]
    decisions: tuple[Decision, ...]
    counts: Mapping[str, float]
    transcript: tuple[dict[str, Any], ...] = ()

    @property
    def actions(self) -> dict[str, Action]:
        return {d.ego: d.action for d in self.decisions}

    def as_dict(self) -> dict[str, Any]:
        # CAVs that go by the same order share its entry.
        written = {key: _order(order) for key, order in {id(s.order): s.order for s in self.situations}.items()}
        return {
            "time": self.time,
            "step": self.step,
            "cavs": [_entry(s, d, written[id(s.order)]) for s, d in zip(self.situations, self.decisions, strict=True)],
        }


def _order(order: PassingOrder) -> dict[str, Any]:
    return {
        "sequence": list(order.sequence),
        "binding": order.binding,
        "precedences": [_plain(p) for p in order.precedences],
    }


def _entry(situation: Situation, decision: Decision, order: dict[str, Any]) -> dict[str, Any]:
    removed = [a for a in situation.assessments if not a.safe]
    return {
        "id": decision.ego,
        "action": str(decision.action),
        "reason": decision.reason,
        "scene": _plain(situation.scene),
        "conflicts": [
            {**_plain(c), "clear_time": _plain(t)}
            for c, t in zip(situation.conflicts, situation.clear_times, strict=True)
        ],
        "order": order,
        "allowed": [str(a) for a in situation.allowed],
        "removed": {str(a.action): list(a.reasons) for a in removed},
        "assessments": [_plain(a) for a in situation.assessments],
        "memories": [memory.text for memory in situation.memories],
        "similarities": [_plain(memory.similarity) for memory in situation.memories],
        "recalled": list(decision.recalled),
    }


def _plain(value: Any) -> Any:  # noqa: ANN401 - any JSON value
    """Turn dataclasses into dicts, round floats to a millionth, and turn what is no finite number into None."""
    if isinstance(value, float):
        return round(value, 6) if isfinite(value) else None
    kind = type(value)
    if kind is str or kind is int or kind is bool or value is None:
        return value
    if kind is tuple or kind is list:
        return [_plain(v) for v in value]
    record = _record(cast("Hashable", kind))
    if record is not None:
        names, read = record
        return {name: v if type(v) is str else _plain(v) for name, v in zip(names, read(value), strict=True)}
    if isinstance(value, dict):
        return {k: _plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in value]
    return str(value) if isinstance(value, str) else value


@lru_cache(maxsize=64)
def _record(kind: Hashable) -> tuple[tuple[str, ...], Callable[[Any], tuple[Any, ...]]] | None:
    """Names of the fields of a dataclass, in their order, and what reads all of them; None for any other kind."""
    names = tuple(f.name for f in fields(kind)) if is_dataclass(kind) else ()
    if len(names) == 1:
        # Asked for a single name, an attrgetter would return the bare value.
        return names, lambda value: (getattr(value, names[0]),)
    return (names, attrgetter(*names)) if names else None
