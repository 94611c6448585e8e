"""``decisions.jsonl``: what was shared, negotiated, removed and decided, one line a decision step."""

import json
import math
from collections.abc import Iterable, Mapping

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
