"""Everything that was said and decided in one decision step."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from math import isfinite
from typing import Any

from codriving.datatypes.action import Action
from codriving.datatypes.situation import Decision, Situation


@dataclass(frozen=True, slots=True)
class Deliberation:
    """One decision step of a method.

    Attributes:
        time: Simulated time [s].
        step: Number of decisions taken before.
        situations: What each CAV was told.
        decisions: What each CAV decided, in the same order.
        counts: Counters of the step (fallbacks, re-asks, ...).
    """

    time: float
    step: int
    situations: tuple[Situation, ...]
    decisions: tuple[Decision, ...]
    counts: Mapping[str, int]

    @property
    def actions(self) -> dict[str, Action]:
        """The action of each CAV, by id."""
        return {d.ego: d.action for d in self.decisions}

    def as_dict(self) -> dict[str, Any]:
        """Return the step as one JSON-ready line: what each CAV was told, what was removed, the order, the decision."""
        return {
            "time": self.time,
            "step": self.step,
            "cavs": [_entry(s, d) for s, d in zip(self.situations, self.decisions, strict=True)],
        }


def _entry(situation: Situation, decision: Decision) -> dict[str, Any]:
    removed = [a for a in situation.assessments if not a.safe]
    return {
        "id": decision.ego,
        "action": str(decision.action),
        "reason": decision.reason,
        "scene": _plain(asdict(situation.scene)),
        "conflicts": [
            {**_plain(asdict(c)), "clear_time": _plain(t)}
            for c, t in zip(situation.conflicts, situation.clear_times, strict=True)
        ],
        "order": {
            "sequence": list(situation.order.sequence),
            "binding": situation.order.binding,
            "precedences": [_plain(asdict(p)) for p in situation.order.precedences],
        },
        "allowed": [str(a) for a in situation.allowed],
        "removed": {str(a.action): list(a.reasons) for a in removed},
        "assessments": [_plain(asdict(a)) for a in situation.assessments],
        "memories": list(situation.memories),
    }


def _plain(value: Any) -> Any:  # noqa: ANN401 - any JSON value
    """Round floats to a millionth and turn what is no finite number into None, so that every line is valid JSON."""
    if isinstance(value, float):
        return round(value, 6) if isfinite(value) else None
    if isinstance(value, dict):
        return {k: _plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in value]
    return str(value) if isinstance(value, str) else value
