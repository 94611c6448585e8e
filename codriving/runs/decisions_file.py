"""``decisions.jsonl``: what was shared, negotiated, removed and decided, one line a decision step."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from codriving.runs.json_lines import lines_text, read_lines

DECISIONS = "decisions.jsonl"


def decisions_text(lines: Iterable[Mapping[str, object]]) -> str:
    """Give the content of ``decisions.jsonl``.

    Args:
        lines: One mapping a decision step. A number that is not finite (no conflict in sight, say) becomes null.

    Raises:
        ValueError: If a value has no place in JSON.
    """
    return lines_text(DECISIONS, lines)


def read_decisions(folder: Path) -> tuple[dict[str, Any], ...]:
    """Read what was decided in one episode.

    Raises:
        RunFolderError: If it is missing, damaged or cannot be read.
    """
    return read_lines(folder / DECISIONS)
