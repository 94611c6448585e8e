"""A value of a YAML against the annotation of the argument it is meant for."""

import math
import types
from collections.abc import Callable, Mapping, Sequence
from enum import Enum
from pathlib import Path
from typing import Any, Literal, Union, get_args, get_origin

_WORDS = {int: "a whole number", float: "a number", bool: "true or false", str: "a text", type(None): "null"}


class MismatchError(Exception):
    """Raised when a value does not have the type that is wanted; the message says which that is."""


def coerce(value: object, wanted: Any) -> object:  # noqa: ANN401 - an annotation has no common type
    """Turn a YAML value into what an annotation asks for, without guessing.

    Whole numbers become floats where a float is wanted, lists become tuples, texts become members of an enumeration or
    paths. Nothing else is converted: ``"5"`` is not 5 and ``4.0`` is not a number of cars. What is not a plain type (a
    protocol, say) is left to the constructor.

    Raises:
        MismatchError: If the value does not fit.
    """
    if wanted in _WORDS or wanted is None:
        return _plain(value, type(None) if wanted is None else wanted)
    origin = get_origin(wanted)
    if origin is Literal:
        return _one_of(value, get_args(wanted))
    if origin in (Union, types.UnionType):
        return _any_of(value, get_args(wanted))
    if origin in (tuple, list, Sequence) or wanted in (tuple, list):
        return _sequence(value, origin or wanted, get_args(wanted))
    if origin in (dict, Mapping) or wanted is dict:
        return _mapping(value, get_args(wanted))
    if isinstance(wanted, type) and issubclass(wanted, Enum):
        return value if isinstance(value, wanted) else wanted(_one_of(value, [member.value for member in wanted]))
    if wanted is Path:
        return Path(str(_plain(value, str)))
    return value


def _plain(value: object, wanted: type) -> object:
    if wanted is float and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if not isinstance(value, wanted) or (isinstance(value, bool) and wanted is not bool):
        raise MismatchError(_WORDS[wanted])
    if isinstance(value, float) and not math.isfinite(value):
        raise MismatchError("a finite number")
    return value


def _one_of(value: object, allowed: Sequence[object]) -> object:
    if value not in allowed or isinstance(value, bool) != isinstance(allowed[list(allowed).index(value)], bool):
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
    if not isinstance(value, list | tuple):
        raise MismatchError(f"a list{_of(parts)}")
    if kind is tuple and parts and parts[-1] is not Ellipsis:
        if len(value) != len(parts):
            raise MismatchError(f"a list of {len(parts)} values")
        return tuple(
            _part(v, part, lambda s: f"a list with {s} in each place") for v, part in zip(value, parts, strict=True)
        )
    inner = parts[0] if parts else object
    items = [_part(v, inner, lambda s: f"a list, each {s}") for v in value]
    return items if kind is list else tuple(items)


def _mapping(value: object, parts: Sequence[object]) -> object:
    if not isinstance(value, Mapping):
        raise MismatchError("a mapping")
    inner = parts[1] if len(parts) == 2 else object
    return {k: _part(v, inner, lambda s: f"a mapping to {s}") for k, v in value.items()}


def _part(value: object, wanted: object, phrase: Callable[[str], str]) -> object:
    try:
        return coerce(value, wanted)
    except MismatchError as err:
        raise MismatchError(phrase(str(err))) from err


def _of(parts: Sequence[object]) -> str:
    return f" of {len(parts)} values" if parts and parts[-1] is not Ellipsis and len(parts) > 1 else ""
