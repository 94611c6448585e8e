"""``decisions.jsonl``: what was shared, negotiated, removed and decided, one line a decision step."""

import json
import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from codriving.errors import RunFolderError
from codriving.storage.records import damaged

DECISIONS = "decisions.jsonl"


def decisions_text(lines: Iterable[Mapping[str, object]]) -> str:
    """Give the content of ``decisions.jsonl``.

    Args:
        lines: One mapping a decision step. A number that is not finite (no conflict in sight, say) becomes null.

    Returns:
        One JSON object a line.

    Raises:
        ValueError: If a value has no place in JSON.
    """
    return "".join(_line(line) + "\n" for line in lines)


def _line(line: Mapping[str, object]) -> str:
    try:
        return _dump(line)
    except ValueError:
        return _dump(_finite(line))
    except TypeError as error:
        raise ValueError(f"a line of {DECISIONS} cannot be written: {error}") from error


def _dump(value: object) -> str:
    return json.dumps(value, allow_nan=False, ensure_ascii=False, separators=(", ", ": "))


def _finite(value: object) -> object:
    """A copy in which what is not finite is absent."""
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, Mapping):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    return value


def read_decisions(folder: Path) -> tuple[dict[str, Any], ...]:
    """Read what was decided in one episode.

    Args:
        folder: Folder of the episode.

    Returns:
        One mapping a decision step.

    Raises:
        RunFolderError: If it is missing, damaged or cannot be read.
    """
    path = folder / DECISIONS
    try:
        # Not splitlines(): it knows line ends that may stand within a text.
        lines = [json.loads(line) for line in path.read_text(encoding="utf-8").split("\n") if line.strip()]
    except FileNotFoundError:
        raise damaged(path, "it is missing") from None
    except OSError as error:
        raise RunFolderError(f"cannot read {path}: {error.strerror}; check its permissions") from error
    except ValueError as error:
        raise damaged(path, str(error)) from error
    if not all(isinstance(line, dict) for line in lines):
        raise damaged(path, "a line is not an object")
    return tuple(lines)
