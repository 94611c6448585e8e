"""``transcript.jsonl``: what a language model was asked and what it answered, one line a question."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from codriving.runs.json_lines import lines_text, read_lines

TRANSCRIPT = "transcript.jsonl"


def transcript_text(lines: Iterable[Mapping[str, object]]) -> str:
    """Give the content of ``transcript.jsonl``.

    Raises:
        ValueError: If a value has no place in JSON.
    """
    return lines_text(TRANSCRIPT, lines)


def read_transcript(folder: Path) -> tuple[dict[str, Any], ...]:
    """Read what a language model was asked in one episode.

    Raises:
        RunFolderError: If it is damaged or cannot be read.
    """
    path = folder / TRANSCRIPT
    return read_lines(path) if path.exists() else ()
