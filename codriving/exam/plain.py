"""Dataclasses as JSON, and back again from the types of their fields."""

from collections.abc import Mapping, Set
from dataclasses import fields, is_dataclass
from enum import StrEnum
from functools import lru_cache
from math import inf, isfinite
from types import UnionType
from typing import Any, Union, get_args, get_origin, get_type_hints

DIGITS = 4  # Behind the point


def plain(value: Any) -> Any:  # noqa: ANN401 - any JSON
    """Turn dataclasses, mappings, sets and numbers without an end into what JSON can hold."""
    if is_dataclass(value):
        return {f.name: plain(getattr(value, f.name)) for f in fields(value)}
    if isinstance(value, Mapping):
        pairs = [(plain(key), plain(inner)) for key, inner in value.items()]
        return dict(pairs) if all(isinstance(key, str) for key, _ in pairs) else [list(pair) for pair in pairs]
    if isinstance(value, Set):
        return sorted(plain(inner) for inner in value)
    if isinstance(value, tuple | list):
        return [plain(inner) for inner in value]
    if isinstance(value, float):
        return (round(float(value), DIGITS) + 0.0) if isfinite(value) else str(value)
    return str(value) if isinstance(value, str) else value


def restored(kind: Any, data: Any) -> Any:  # noqa: ANN401 - any type and any JSON
    """Make a value of a type of what ``plain`` has made of it.

    Raises:
        ValueError: If it is none of that type.
    """
    if isinstance(kind, type) and is_dataclass(kind):
        known = _types(kind)
        if not isinstance(data, dict) or not data.keys() <= known.keys():
            raise ValueError(f"no {kind.__name__}")
        return kind(**{name: restored(known[name], inner) for name, inner in data.items()})
    if kind is float:
        return inf if data is None else float(data)  # As decisions.jsonl has it
    if isinstance(kind, type) and issubclass(kind, StrEnum):
        return kind(data)
    return _of_several(get_origin(kind), get_args(kind), data)


def _of_several(origin: Any, inner: tuple[Any, ...], data: Any) -> Any:  # noqa: ANN401
    if origin in (Union, UnionType):
        return None if data is None else restored(next(one for one in inner if one is not type(None)), data)
    if origin is list:
        return [restored(inner[0], value) for value in data]
    if origin is tuple:
        each = [inner[0]] * len(data) if inner[1:] == (...,) else inner
        return tuple(restored(one, value) for one, value in zip(each, data, strict=True))
    if isinstance(origin, type) and issubclass(origin, Mapping):
        pairs = data.items() if isinstance(data, dict) else data
        return {restored(inner[0], key): restored(inner[1], value) for key, value in pairs}
    if isinstance(origin, type) and issubclass(origin, Set):
        return frozenset(restored(inner[0], value) for value in data)
    return data


@lru_cache(maxsize=64)
def _types(kind: type) -> dict[str, Any]:
    return get_type_hints(kind)
