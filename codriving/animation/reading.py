"""What a line of ``decisions.jsonl`` holds under a key, whatever a method has written there."""

from collections.abc import Mapping, Sequence
from typing import Any


def text_in(entry: Mapping[str, Any], key: str) -> str:
    """Return a text, or none."""
    value = entry.get(key)
    return value if isinstance(value, str) else ""


def number_in(entry: Mapping[str, Any], key: str) -> float | None:
    """Return a number, or None."""
    value = entry.get(key)
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else None


def map_in(entry: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    """Return an object, or an empty one."""
    value = entry.get(key)
    return value if isinstance(value, Mapping) else {}


def maps_in(entry: Mapping[str, Any], key: str) -> list[Mapping[str, Any]]:
    """Return the objects of a list."""
    return [value for value in list_in(entry, key) if isinstance(value, Mapping)]


def texts_in(entry: Mapping[str, Any], key: str) -> tuple[str, ...]:
    """Return the texts of a list."""
    return tuple(value for value in list_in(entry, key) if isinstance(value, str))


def list_in(entry: Mapping[str, Any], key: str) -> Sequence[Any]:
    """Return a list, or an empty one."""
    value = entry.get(key)
    return value if isinstance(value, list | tuple) else ()
