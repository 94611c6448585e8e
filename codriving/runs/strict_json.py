"""Frozen dataclasses as JSON and back, checked field by field: what was written is what is read."""

import dataclasses
import enum
import functools
import json
import math
import types
import typing
from collections.abc import Mapping
from typing import TypeVar

T = TypeVar("T")


def encode(value: object) -> str:
    """Write a dataclass as JSON.

    Raises:
        ValueError: If a field is of another type than declared, or not finite.
    """
    if not dataclasses.is_dataclass(value) or isinstance(value, type):
        raise ValueError(f"expected a dataclass, got {value!r}")
    try:
        text = json.dumps(dataclasses.asdict(value), indent=2, allow_nan=False, ensure_ascii=False) + "\n"
    except TypeError as error:
        raise ValueError(f"{type(value).__name__}: {error}") from error
    # A record that could not be read again is worse than none: find out now.
    decode(type(value), text)
    return text


def decode(kind: type[T], text: str) -> T:
    """Read a dataclass from JSON.

    Raises:
        ValueError: If the text is not JSON, a field is missing, unknown, of another type, or not finite.
    """
    plain = json.loads(text, parse_constant=_refuse_constant)
    return typing.cast(T, _convert(kind, plain, ""))


def _refuse_constant(name: str) -> object:
    raise ValueError(f"{name} is not a number")


@functools.cache
def _fields(kind: type) -> Mapping[str, object]:
    """Name and resolved type of each field."""
    return typing.get_type_hints(kind)


def _convert(kind: object, value: object, where: str) -> object:
    """Check a plain JSON value against a declared type and give it that type."""
    origin = typing.get_origin(kind)
    if kind == int | float:
        # A counter stays one, an amount stays one.
        return value if type(value) is int else _number(value, where)
    if origin in (types.UnionType, typing.Union):
        return _optional(kind, value, where)
    if origin is tuple:
        (inner, _) = typing.get_args(kind)
        items = _expect(list, value, where)
        return tuple(_convert(inner, item, f"{where}[{i}]") for i, item in enumerate(items))
    if origin is dict:
        (_, inner) = typing.get_args(kind)
        pairs = _expect(dict, value, where)
        return {name: _convert(inner, item, f"{where}.{name}") for name, item in pairs.items()}
    if isinstance(kind, type) and dataclasses.is_dataclass(kind):
        return _object(kind, _expect(dict, value, where), where)
    if isinstance(kind, type) and issubclass(kind, enum.Enum):
        return _choice(kind, value, where)
    if kind is float:
        return _number(value, where)
    if isinstance(kind, type):
        return _expect(kind, value, where)
    raise TypeError(f"{where or 'value'}: no rule to read {kind!r}")


def _optional(kind: object, value: object, where: str) -> object:
    """``X | None``, the only union of other types that is used."""
    (inner,) = (option for option in typing.get_args(kind) if option is not type(None))
    return None if value is None else _convert(inner, value, where)


def _object(kind: type, pairs: dict[str, object], where: str) -> object:
    declared = _fields(kind)
    prefix = f"{where}." if where else ""
    # What came later has a default, so that older files stay readable.
    later = {field.name for field in dataclasses.fields(kind) if field.default is not dataclasses.MISSING}
    if missing := [name for name in declared if name not in pairs and name not in later]:
        raise ValueError(f"field {prefix}{missing[0]} is missing")
    if unknown := [name for name in pairs if name not in declared]:
        raise ValueError(f"field {prefix}{unknown[0]} is unknown")
    return kind(**{name: _convert(declared[name], value, f"{prefix}{name}") for name, value in pairs.items()})


def _choice(kind: type[enum.Enum], value: object, where: str) -> enum.Enum:
    try:
        return kind(value)
    except ValueError:
        choices = ", ".join(str(member.value) for member in kind)
        raise ValueError(f"field {where} must be one of {choices}, got {value!r}") from None


def _number(value: object, where: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError(f"field {where} must be a number, got {value!r}")
    if not math.isfinite(value):
        raise ValueError(f"field {where} must be finite, got {value!r}")
    return float(value)


def _expect(kind: type[T], value: object, where: str) -> T:
    # type() and not isinstance(): True is an int to Python, but no seed.
    if type(value) is not kind:
        raise ValueError(f"field {where or 'at the top'} must be {kind.__name__}, got {value!r}")
    return value
