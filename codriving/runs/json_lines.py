"""Files of one JSON object a line: strict, and harmless on a terminal whatever a language model wrote."""

import json
import math
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from codriving.errors import RunFolderError
from codriving.runs.records import damaged

_HARMFUL = re.compile(
    "[\x7f-\x9f\u061c\u200b-\u200f\u2028-\u202e\u2060-\u206f\ud800-\udfff\ufeff\ufff9-\ufffb\U000e0000-\U000e007f]"
)
"""What moves a cursor or turns text round, ends a line for some readers, or is no character at all."""


def lines_text(name: str, lines: Iterable[Mapping[str, object]]) -> str:
    """Give the content of such a file.

    Raises:
        ValueError: If a value has no place in JSON.
    """
    return "".join(_line(name, line) + "\n" for line in lines)


def _line(name: str, line: Mapping[str, object]) -> str:
    try:
        return _dump(line)
    except ValueError:
        return _dump(_finite(line))
    except TypeError as error:
        raise ValueError(f"a line of {name} cannot be written: {error}") from error


def _dump(value: object) -> str:
    text = json.dumps(value, allow_nan=False, ensure_ascii=False, separators=(", ", ": "))
    # Such characters stand within strings only.
    return _HARMFUL.sub(lambda found: json.dumps(found[0])[1:-1], text)


def _finite(value: object) -> object:
    """A copy in which what is not finite is absent."""
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, Mapping):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    return value


def read_lines(path: Path) -> tuple[dict[str, Any], ...]:
    """Read such a file of an episode.

    Raises:
        RunFolderError: If it is missing, damaged or cannot be read.
    """
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
