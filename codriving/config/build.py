"""Config nodes to objects: the one place where a `_target_` is called, once its class is known to fit."""

import inspect
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, TypeVar, get_args

from codriving.config.coerce import MismatchError, coerce
from codriving.config.schema import check_root, unknown
from codriving.config.target import find_class
from codriving.datatypes.parts import CaseMemory, Method, Metric, Model, Scenario, Simulator
from codriving.errors import ConfigError

T = TypeVar("T")

TARGET = "_target_"

Given = Mapping[type, object]
"""Objects that are handed to every constructor that has a parameter annotated with their class."""


def build(node: object, expected: type[T], key: str = "", plugins: Sequence[str] = (), given: Given | None = None) -> T:
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
    for target in targets(node):
        annotations = _annotations(find_class(target, "the node", plugins)).values()
        if any(wanted in _classes(annotation) for annotation in annotations):
            return True
    return False


def targets(node: object) -> Iterator[str]:
    """Yield each class that a config names."""
    inner = node.values() if isinstance(node, Mapping) else node if isinstance(node, list) else ()
    if isinstance(node, Mapping) and isinstance(node.get(TARGET), str):
        yield node[TARGET]
    for value in inner:
        yield from targets(value)


def _build(node: object, expected: Sequence[type], key: str, plugins: Sequence[str], given: Given) -> Any:  # noqa: ANN401
    if not isinstance(node, Mapping) or TARGET not in node:
        raise ConfigError(f"{key or 'the node'} must hold a {TARGET}, got {node!r}")
    cls = find_class(node[TARGET], key, plugins)
    _check_class(cls, node[TARGET], expected, key)
    arguments = {str(name): value for name, value in node.items() if name != TARGET}
    annotations = _annotations(cls)
    handed = {n: given[c] for n, a in annotations.items() for c in _classes(a) if c in given}
    for name, value in handed.items():
        if value is None and type(None) not in get_args(annotations[name]):
            raise ConfigError(f"{key or cls.__name__} cannot do without {name}, and none is chosen; set {name}=<name>")
    for name in handed.keys() & arguments.keys():
        raise ConfigError(
            f"{_join(key, name)} is not set here since release 0.2: {cls.__name__} is handed what {name}= chooses; "
            f"delete the line `{name}:` from its YAML"
        )
    _check_names({**arguments, **handed}, cls, key)
    for name, value in arguments.items():
        arguments[name] = _argument(value, annotations.get(name, object), _join(key, name), plugins, given)
    try:
        return cls(**arguments, **handed)
    except ConfigError as err:
        raise type(err)(_locate(str(err), key, arguments)) from err
    except ValueError as err:
        raise ConfigError(_locate(str(err), key, arguments)) from err


def _check_class(cls: type, target: str, expected: Sequence[type], key: str) -> None:
    """Refuse a class that its place does not expect, before anything of it is called."""
    if not any(one in cls.__mro__ for one in expected):
        names = " or ".join(one.__name__ for one in expected) or "a plain value"
        raise ConfigError(
            f"{key or 'the node'} must be {names}, but {target} is none; name another class, or let it inherit from "
            f"{' or '.join(f'{one.__module__}.{one.__name__}' for one in expected) or 'what is expected there'}"
        )


def _check_names(arguments: Mapping[str, object], cls: type, key: str) -> None:
    parameters = _parameters(cls)
    for name in arguments:
        if name not in parameters:
            raise unknown(_join(key, name), parameters, key or cls.__name__)
    for name, parameter in parameters.items():
        if parameter.default is parameter.empty and name not in arguments:
            raise ConfigError(f"{_join(key, name)} is missing; {cls.__name__} needs it")


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


def _argument(value: object, annotation: object, key: str, plugins: Sequence[str], given: Given) -> object:
    made = _nested(value, _classes(annotation), key, plugins, given)
    try:
        return coerce(made, annotation)
    except MismatchError as err:
        raise ConfigError(f"{key} must be {err}, got {value!r}") from err


def _nested(value: object, expected: Sequence[type], key: str, plugins: Sequence[str], given: Given) -> object:
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


EXPECTED: dict[str, type] = {
    "scenario": Scenario,
    "executor": object,
    "cda": object,
    "llm": Model,
    "memory": CaseMemory,
    "metrics": Metric,
    "launcher": object,
    "environment": Simulator,
}
"""What each node has to be; those of a room further up are checked again where a method or a run takes them."""


def validate(resolved: Mapping[str, Any]) -> None:
    """Check keys, types and ranges of every node by building it, and last the method, which refers to others.

    Raises:
        ConfigError: With the full key, the rule and the value that broke it.
    """
    check_root(resolved)
    plugins = resolved["plugins"]
    made: dict[str, Any] = {
        name: build(resolved[name], expected, name, plugins)
        for name, expected in EXPECTED.items()
        if resolved[name] is not None
    }
    build(resolved["method"], Method, "method", plugins, {Model: made["llm"], CaseMemory: made.get("memory")})
