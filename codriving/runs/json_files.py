"""JSON of a run folder, checked when written and when read: one object a file, or one a line."""

import functools
import json
import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from pathlib import Path
from types import GenericAlias
from typing import TYPE_CHECKING, Any, TypeVar

from pydantic import ConfigDict, TypeAdapter, ValidationError

from codriving.errors import DamagedEpisodeError, RunFolderError

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

T = TypeVar("T")

_STRICT = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)

# What moves a cursor or turns text round, ends a line for some readers, or is no character at all.
_HARMFUL = re.compile(
    "[\x7f-\x9f\u061c\u200b-\u200f\u2028-\u202e\u2060-\u206f\ud800-\udfff\ufeff\ufff9-\ufffb\U000e0000-\U000e007f]"
)


# Fields that came later, and are written where they hold something: other files are as before.
_CAME_LATER = ("flow", "repeatable")


@functools.cache
def _adapter(kind: type) -> TypeAdapter[Any]:
    # In a tuple, since Pydantic takes no settings for a plain dataclass by itself.
    alone: Any = GenericAlias(tuple, (kind,))
    return TypeAdapter(alone, config=_STRICT)


def encode(value: "DataclassInstance") -> str:
    """Write a dataclass as JSON.

    Raises:
        ValueError: If a field is of another type than declared, or not finite.
    """
    try:
        text = json.dumps(asdict(value, dict_factory=_named), indent=2, allow_nan=False, ensure_ascii=False) + "\n"
    except TypeError as error:
        raise ValueError(f"{type(value).__name__}: {error}") from error
    # A record that could not be read again is worse than none: find out now.
    decode(type(value), text)
    return text


def _named(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    return {name: value for name, value in pairs if value is not None or name not in _CAME_LATER}


def decode(kind: type[T], text: str) -> T:
    """Read a dataclass from JSON."""
    try:
        value: T = _adapter(kind).validate_json(f"[{text}]")[0]  # type: ignore[arg-type]
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        field = ".".join(map(str, first["loc"][1:]))
        raise ValueError(f"{field}: {first['msg']}, got {first['input']!r:.100}" if field else first["msg"]) from error
    return value


def lines_text(name: str, lines: Iterable[Mapping[str, object]]) -> str:
    """Write a file of one JSON object a line, harmless on a terminal whatever a language model wrote."""
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
    if text.isascii() and "\x7f" not in text:
        return text
    # Such characters stand within strings only.
    return _HARMFUL.sub(lambda found: json.dumps(found[0])[1:-1], text)


def _finite(value: object) -> object:
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, Mapping):
        return {key: _finite(item) for key, item in value.items()}
    return [_finite(item) for item in value] if isinstance(value, list | tuple) else value


def parse_json(text: str) -> Any:  # noqa: ANN401 - any JSON
    """Read JSON; what nests too deep is no better than what breaks off.

    Raises:
        ValueError: If it is none.
    """
    try:
        return json.loads(text)
    except RecursionError:
        raise ValueError("it nests too deep") from None


def read_episode_text(path: Path) -> str:
    """Read a file of an episode."""
    try:
        return read_episode_bytes(path).decode()
    except UnicodeDecodeError as error:
        raise damaged(path, str(error)) from error


def read_episode_bytes(path: Path) -> bytes:
    """Read a file of an episode as it is."""
    try:
        return path.read_bytes()
    except FileNotFoundError:
        raise damaged(path, "it is missing") from None
    except (IsADirectoryError, NotADirectoryError) as error:
        raise damaged(path, str(error.strerror)) from error
    except OSError as error:
        raise RunFolderError(f"cannot read {path}: {error.strerror}; check its permissions") from error


def read_lines(path: Path) -> tuple[dict[str, Any], ...]:
    """Read a file of one JSON object a line."""
    try:
        # Not splitlines(): it knows line ends that may stand within a text.
        lines = [parse_json(line) for line in read_episode_text(path).split("\n") if line.strip()]
    except ValueError as error:
        raise damaged(path, str(error)) from error
    if not all(isinstance(line, dict) for line in lines):
        raise damaged(path, "a line is not an object")
    return tuple(lines)


def damaged(path: Path, reason: str) -> DamagedEpisodeError:
    """Return the error for a file of an episode that cannot be trusted, with its cure."""
    return DamagedEpisodeError(
        f"{path} is damaged ({reason}); run again with the same run=<name>: only this episode is repeated"
    )
