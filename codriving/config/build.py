"""Config nodes to objects: the one place where a `_target_` is called, once its class is known to fit."""

import inspect
import math
import types
from collections.abc import Iterator, Mapping, Sequence
from enum import Enum
from pathlib import Path
from typing import Any, Literal, TypeVar, Union, get_args, get_origin

from codriving.config.choices import choices, values
from codriving.config.plugins import refuse_missing
from codriving.config.schema import GROUPS, check_root, texts, unknown, value_shown
from codriving.config.target import find_class
from codriving.datatypes import (
    ActionFilter,
    CaseMemory,
    Communication,
    Cooperation,
    Drivers,
    EpisodeLauncher,
    Flow,
    HumanJudge,
    Method,
    Metric,
    Model,
    OrderExecutor,
    OrderOfCavs,
    Scenario,
    Simulator,
    ThinkingTime,
    VehicleLimits,
)
from codriving.errors import ConfigError

T = TypeVar("T")

TARGET = "_target_"

# Objects that are handed to every constructor that has a parameter annotated with their class.
HandedIn = Mapping[type, object]


def build(
    node: object, expected: type[T], key: str = "", plugins: Sequence[str] = (), given: HandedIn | None = None
) -> T:
    """Construct what a node describes, and first whatever its own keys describe.

    A node is a constructor call: ``_target_`` names the class, every other key is one of its arguments. What the class
    of a nested node has to be is the annotation of the argument. Nothing is filled in but what is given, and nothing is
    dropped.

    Args:
        node: A mapping with a ``_target_``.
        expected: What its class has to be or to inherit from.
        key: Name of the node in messages.
        plugins: Packages besides ours whose classes may be named.

    Raises:
        ConfigError: If the class is not allowed, a key is unknown or missing, or a value has the wrong type or range.
    """
    made: T = _build(node, (expected,), key, plugins, given or {})
    return made


def asks_for(node: object, wanted: type, plugins: Sequence[str] = ()) -> bool:
    """Tell whether a class that a node names, itself or further inside, has a parameter annotated with a class."""
    annotated = (_annotations(find_class(target, "the node", plugins)) for target in targets(node))
    return any(wanted in _classes(annotation) for found in annotated for annotation in found.values())


def targets(node: object) -> Iterator[str]:
    """Yield each class that a config names."""
    return (text for key, text in texts(node) if key.rpartition(".")[2] == TARGET)


def _build(node: object, expected: Sequence[type], key: str, plugins: Sequence[str], given: HandedIn) -> Any:  # noqa: ANN401
    if not isinstance(node, Mapping) or TARGET not in node:
        raise ConfigError(f"{key or 'the node'} must hold a {TARGET}, got {value_shown(node)}")
    cls = find_class(node[TARGET], key, plugins)
    if not any(one in cls.__mro__ for one in expected):
        names = " or ".join(one.__name__ for one in expected) or "a plain value"
        raise ConfigError(
            f"{key or 'the node'} must be {names}, but {node[TARGET]} is none; name another class, or let it inherit "
            f"from {' or '.join(f'{one.__module__}.{one.__name__}' for one in expected) or 'what is expected there'}"
        )
    arguments = {str(name): value for name, value in node.items() if name != TARGET}
    parameters, annotations = _parameters(cls), _annotations(cls)
    handed = {n: given[c] for n, a in annotations.items() for c in _classes(a) if c in given}
    for name, value in handed.items():
        if value is None and type(None) not in get_args(annotations[name]):
            raise ConfigError(f"{key or cls.__name__} cannot do without {name}, and none is chosen; set {name}=<name>")
    for name in handed.keys() & arguments.keys():
        raise ConfigError(
            f"{_join(key, name)} is not set here since release 0.2: {cls.__name__} is handed what {name}= chooses; "
            f"delete the line `{name}:` from its YAML"
        )
    for name in arguments:
        if name not in parameters:
            files = choices(key) if key in GROUPS else {}
            others = [other for other, file in files.items() if name in values(file)]
            raise unknown(_join(key, name), parameters, key or cls.__name__, others)
    for name, parameter in parameters.items():
        if parameter.default is parameter.empty and name not in {**arguments, **handed}:
            raise ConfigError(f"{_join(key, name)} is missing; {cls.__name__} needs it")
    for name, value in arguments.items():
        annotation = annotations.get(name, object)
        made = _nested(value, _classes(annotation), _join(key, name), plugins, given)
        try:
            arguments[name] = coerce(made, annotation)
        except MismatchError as err:
            raise ConfigError(f"{_join(key, name)} must be {err}, got {value_shown(value)}") from err
    try:
        return cls(**arguments, **handed)
    except ConfigError as err:
        raise type(err)(_locate(str(err), key, arguments)) from err
    except ValueError as err:
        raise ConfigError(_locate(str(err), key, arguments)) from err


def _parameters(cls: type) -> dict[str, inspect.Parameter]:
    named = (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)
    return {name: p for name, p in inspect.signature(cls).parameters.items() if p.kind in named}


def _annotations(cls: type) -> dict[str, Any]:
    """Read the annotations of the arguments; those that only a type checker can resolve are left out."""
    found = {}
    for name, parameter in _parameters(cls).items():
        annotation = parameter.annotation
        if isinstance(annotation, str):
            module = inspect.getmodule(cls)
            try:
                annotation = eval(annotation, dict(vars(module)) if module else {})
            except NameError:
                continue
        if annotation is not parameter.empty:
            found[name] = annotation
    return found


def _classes(annotation: Any) -> tuple[type, ...]:  # noqa: ANN401 - an annotation has no common type
    """The classes that an annotation names, in a union, a list or a mapping too, apart from those of plain values."""
    parts = get_args(annotation)
    if parts:
        return tuple(cls for part in parts for cls in _classes(part))
    return (annotation,) if isinstance(annotation, type) and annotation.__module__ not in ("builtins", "typing") else ()


def _nested(value: object, expected: Sequence[type], key: str, plugins: Sequence[str], given: HandedIn) -> object:
    if isinstance(value, Mapping):
        if TARGET in value:
            return _build(value, expected, key, plugins, given)
        return {k: _nested(inner, expected, _join(key, str(k)), plugins, given) for k, inner in value.items()}
    if isinstance(value, list):
        return [_nested(inner, expected, f"{key}.{k}", plugins, given) for k, inner in enumerate(value)]
    return value


def _locate(message: str, key: str, arguments: Mapping[str, object]) -> str:
    """Put the key before a constructor's message, which names the argument alone or with its node (``cda.binding``)."""
    if not key:
        return message
    own = key.rpartition(".")[2]
    if message.startswith(f"{own}."):
        return key + message.removeprefix(own)
    first = message.split(" ", 1)[0]
    return f"{key}.{message}" if first.partition("[")[0] in arguments else f"{key}: {message}"


def _join(key: str, name: str) -> str:
    return f"{key}.{name}" if key else name


_WORDS = {int: "a whole number", float: "a number", bool: "true or false", str: "a text", type(None): "null"}


class MismatchError(Exception):
    """Raised when a value does not have the type that is wanted; the message says which that is."""


def coerce(value: object, wanted: Any) -> object:  # noqa: ANN401 - an annotation has no common type
    """Turn a YAML value into what an annotation asks for, without guessing.

    Whole numbers become floats where a float is wanted, lists become tuples, texts become members of an enumeration or
    paths. Nothing else is converted: ``"5"`` is not 5 and ``4.0`` is not a number of cars. What is not a plain type is
    left to the constructor.
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
    if type(value) is int and wanted in (int, float) and not -(2**63) < value < 2**63:
        raise MismatchError("a number of less than 19 digits")
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


EXPECTED: dict[str, type] = {"scenario": Scenario, "executor": OrderExecutor, "cda": Cooperation, "llm": Model}
EXPECTED |= {
    "order": OrderOfCavs,
    "filter": ActionFilter,
    "memory": CaseMemory,
    "metrics": Metric,
    "launcher": EpisodeLauncher,
    "limits": VehicleLimits,
    "drivers": Drivers,
    "flow": Flow,
    "v2x": Communication,
    "judgement": HumanJudge,
    "thinking": ThinkingTime,
    "environment": Simulator,  # Last, so that refusals name limits.lateral, as a user does
}
"""What each node has to be, known before its class is called: a file chooses no other code than a part of its kind."""


def validate(resolved: Mapping[str, Any]) -> None:
    """Check keys, types and ranges of every node by building it, and last the method, which refers to others.

    Raises:
        ConfigError: With the full key, the rule and the value that broke it.
    """
    check_root(resolved)
    plugins = resolved["plugins"]
    refuse_missing(plugins)
    chosen = {name: expected for name, expected in EXPECTED.items() if resolved[name] is not None}
    made: dict[str, Any] = {name: build(resolved[name], expected, name, plugins) for name, expected in chosen.items()}
    build(resolved["method"], Method, "method", plugins, {Model: made["llm"], CaseMemory: made.get("memory")})
