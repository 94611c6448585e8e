"""``timing.json``: what an episode cost in time, kept apart from all that must repeat to the byte."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from codriving.runs.strict_json import decode, encode

TIMING = "timing.json"

_LATER = {"decision_cpu_mean": None, "decision_cpu_max": None}
"""Fields that files of earlier versions do not have."""


@dataclass(frozen=True, slots=True)
class Timing:
    """Wall-clock time of one episode, and the computing time of its decisions.

    Attributes:
        seconds: The whole episode [s].
        decision_mean: Mean time of a decision [s], or None without decisions.
        decision_max: Longest decision [s], or None without decisions.
        decision_cpu_mean: Mean CPU time of a decision, of the thread that decides [s]; None where it was not measured.
        decision_cpu_max: Largest CPU time of a decision [s], or None.
    """

    seconds: float
    decisions: int
    decision_mean: float | None
    decision_max: float | None
    decision_cpu_mean: float | None = None
    decision_cpu_max: float | None = None


def timing_of(seconds: float, decision_seconds: Sequence[float], decision_cpu: Sequence[float] = ()) -> Timing:
    """Sum up what was measured.

    Args:
        seconds: Wall-clock time of the episode [s].
        decision_seconds: Wall-clock time of each decision [s].
        decision_cpu: CPU time of each decision [s]; nothing where it was not measured.
    """
    mean, longest = _mean_and_max(decision_seconds)
    return Timing(seconds, len(decision_seconds), mean, longest, *_mean_and_max(decision_cpu))


def _mean_and_max(values: Sequence[float]) -> tuple[float | None, float | None]:
    return (sum(values) / len(values), max(values)) if values else (None, None)


def timing_text(timing: Timing) -> str:
    """Give the content of ``timing.json``."""
    return encode(timing)


def read_timing(folder: Path) -> Timing | None:
    """Read the timing of one episode.

    Returns:
        The timing, or None where there is none to read: no result depends on it. What an earlier version did not
        measure is None.
    """
    try:
        pairs = json.loads((folder / TIMING).read_text(encoding="utf-8"))
        return decode(Timing, json.dumps({**_LATER, **pairs} if isinstance(pairs, dict) else pairs))
    except (OSError, ValueError):
        return None
