"""``timing.json``: what an episode cost in wall-clock time, kept apart from all that must repeat to the byte."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from codriving.storage.strict_json import decode, encode

TIMING = "timing.json"


@dataclass(frozen=True, slots=True)
class Timing:
    """Wall-clock time of one episode.

    Attributes:
        seconds: The whole episode [s].
        decisions: Number of decisions timed.
        decision_mean: Mean time of a decision [s], or None without decisions.
        decision_max: Longest decision [s], or None without decisions.
    """

    seconds: float
    decisions: int
    decision_mean: float | None
    decision_max: float | None


def timing_of(seconds: float, decision_seconds: Sequence[float]) -> Timing:
    """Sum up what was measured.

    Args:
        seconds: Wall-clock time of the episode [s].
        decision_seconds: Wall-clock time of each decision [s].

    Returns:
        The summary.
    """
    n = len(decision_seconds)
    if n == 0:
        return Timing(seconds, 0, None, None)
    return Timing(seconds, n, sum(decision_seconds) / n, max(decision_seconds))


def timing_text(timing: Timing) -> str:
    """Give the content of ``timing.json``.

    Args:
        timing: What was measured.

    Returns:
        JSON text.
    """
    return encode(timing)


def read_timing(folder: Path) -> Timing | None:
    """Read the timing of one episode.

    Args:
        folder: Folder of the episode.

    Returns:
        The timing, or None where there is none to read: no result depends on it.
    """
    try:
        return decode(Timing, (folder / TIMING).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
