"""A value of a YAML against the annotation of the argument it is meant for."""

import math
import types
from collections.abc import Mapping, Sequence
from enum import Enum
from pathlib import Path
from typing import Any, Literal, Union, get_args, get_origin

_WORDS = {int: "a whole number", float: "a number", bool: "true or false", str: "a text", type(None): "null"}


class MismatchError(Exception):
    """Raised when a value does not have the type that is wanted; the message says which that is."""


def coerce(value: object, wanted: Any) -> object:  # noqa: ANN401 - an annotation has no common type
    """Turn a YAML value into what an annotation asks for, without guessing.

    Whole numbers become floats where a float is wanted, lists become tuples, texts become members of an enumeration or
    paths. Nothing else is converted: ``"5"`` is not 5 and ``4.0`` is not a number of cars. What is not a plain type is
    left to the constructor.

    Raises:
        MismatchError: If the value does not fit.
    """
    wanted = type(None) if wanted is None else wanted
    origin, parts = get_origin(wanted), get_args(wanted)
    if wanted in _WORDS:
        return _plain(value, wanted)
    if origin is Literal:
        return _one_of(value, parts)
    if origin in (Union, types.UnionType):
        return _any_of(value, parts)
    if (origin or wanted) in (tuple, list, Sequence):
        return _sequence(value, origin or wanted, parts)
    if (origin or wanted) in (dict, Mapping):
        if not isinstance(value, Mapping):
            raise MismatchError("a mapping")
        return {k: _part(v, parts[1] if parts else object, "a mapping to {}") for k, v in value.items()}
    if isinstance(wanted, type) and issubclass(wanted, Enum):
        return value if isinstance(value, wanted) else wanted(_one_of(value, [member.value for member in wanted]))
    return Path(str(_plain(value, str))) if wanted is Path else value


def _plain(value: object, wanted: type) -> object:
    if wanted is float and type(value) is int:
        return float(value)
    if not isinstance(value, wanted) or (isinstance(value, bool) and wanted is not bool):
        raise MismatchError(_WORDS[wanted])
    if isinstance(value, float) and not math.isfinite(value):
        raise MismatchError("a finite number")
    return value


def _one_of(value: object, allowed: Sequence[object]) -> object:
    if not any(value == one and isinstance(value, bool) == isinstance(one, bool) for one in allowed):
        raise MismatchError(f"one of {', '.join(map(str, allowed))}")
    return value


def _any_of(value: object, options: Sequence[object]) -> object:
    wanted = []
    # An exact fit comes first, so that 3 stays an int where int | float is wanted.
    for option in sorted(options, key=lambda option: type(value) is not option):
        try:
            return coerce(value, option)
        except MismatchError as err:
            wanted.append(str(err))
    raise MismatchError(" or ".join(dict.fromkeys(wanted)))


def _sequence(value: object, kind: Any, parts: Sequence[object]) -> object:  # noqa: ANN401
    fixed = kind is tuple and len(parts) > 0 and parts[-1] is not Ellipsis
    if not isinstance(value, list | tuple) or (fixed and len(value) != len(parts)):
        raise MismatchError(f"a list of {len(parts)} values" if fixed and len(parts) > 1 else "a list")
    if fixed:
        return tuple(_part(v, part, "a list with {} in each place") for v, part in zip(value, parts, strict=True))
    items = [_part(v, parts[0] if parts else object, "a list, each {}") for v in value]
    return items if kind is list else tuple(items)


def _part(value: object, wanted: object, phrase: str) -> object:
    try:
        return coerce(value, wanted)
    except MismatchError as err:
        raise MismatchError(phrase.format(err)) from err
