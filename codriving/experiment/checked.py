"""What ``codriving check`` has to say about the answers of a model."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

from codriving.errors import ModelError

LONGEST = 300
"""Characters of an answer that are shown."""

_NAMES = {"negotiate": "Negotiation", "decide": "Decision"}


def verdict(transcript: Sequence[Mapping[str, Any]]) -> tuple[int, list[str]]:
    """Say what was answered, and whether it could be used.

    Args:
        transcript: What was asked and answered, as in ``transcript.jsonl``.

    Returns:
        The exit code, 1 if a fallback was needed, and what to print.

    Raises:
        ModelError: If nothing was asked.
    """
    if not transcript:
        raise ModelError("the model was not asked anything in this scene; leave scenario= and cda= out")
    lines = [text for line in transcript for text in [*_answer(line), ""]]
    missing = [_NAMES.get(line["purpose"], line["purpose"]).lower() for line in transcript if line["value"] is None]
    if missing:
        return 1, [*lines, f"No usable answer for the {' and the '.join(missing)}: a fallback was needed."]
    return 0, [*lines, "Answered in the form asked for."]


def _answer(line: Mapping[str, Any]) -> list[str]:
    calls = line["calls"]
    title = _NAMES.get(line["purpose"], line["purpose"])
    costs = [call["cost"] for call in calls]
    shown = {
        "answer": "none that can be used" if line["value"] is None else _shown(json.dumps(line["value"])),
        "problem": _shown(line["problem"]),
        "said": _shown(calls[-1]["text"]) if line["value"] is None and calls else "",
        "form": calls[-1]["form"] if calls else "",
        "latency": f"{sum(call['seconds'] for call in calls):.2f} s",
        "tokens": f"{_total(calls, 'prompt_tokens')} of the prompt, {_total(calls, 'completion_tokens')} of the answer",
        "cost": "no price known" if None in costs else f"{sum(costs):.6f} USD",
        "re-asks": str(max(0, len(calls) - 1 - line["shortened"])),
    }
    subject = f" of {_shown(line['subject'])}" if line["subject"] else ""
    return [f"{title}{subject}", *(f"  {name:<8} {text}" for name, text in shown.items() if text)]


def _total(calls: Sequence[Mapping[str, Any]], name: str) -> int:
    return sum(call[name] for call in calls)


def _shown(text: str) -> str:
    """A text on one line; what a terminal would take for a command is escaped."""
    plain = "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in " ".join(text.split()))
    return plain if len(plain) <= LONGEST else f"{plain[:LONGEST]}..."
