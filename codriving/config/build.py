"""Config nodes to objects: the one place where a `_target_` is called."""

import inspect
from collections.abc import Mapping, Sequence
from typing import Any

from codriving.config.coerce import MismatchError, coerce
from codriving.config.schema import unknown
from codriving.config.target import find_class
from codriving.errors import ConfigError

TARGET = "_target_"


def build(node: Mapping[str, Any], plugins: Sequence[str] = (), key: str = "") -> Any:  # noqa: ANN401 - any class
    """Construct what a node describes, and first whatever its own keys describe.

    A node is a constructor call: ``_target_`` names the class, every other key is one of its arguments. Nothing is
    filled in, nothing is dropped.

    Args:
        node: A mapping with a ``_target_``.

    Raises:
        ConfigError: If the class is not allowed, a key is unknown or missing, or a value has the wrong type or range.
    """
    if not isinstance(node, Mapping) or TARGET not in node:
        raise ConfigError(f"{key or 'the node'} must hold a {TARGET}, got {node!r}")
    cls = find_class(node[TARGET], key, plugins)
    arguments = {str(name): value for name, value in node.items() if name != TARGET}
    annotations = _annotations(cls)
    _check_names(arguments, cls, key)
    for name, value in arguments.items():
        arguments[name] = _argument(value, annotations.get(name, object), _join(key, name), plugins)
    try:
        return cls(**arguments)
    except ConfigError as err:
        raise type(err)(_locate(str(err), key, arguments)) from err
    except ValueError as err:
        raise ConfigError(_locate(str(err), key, arguments)) from err


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
    module = inspect.getmodule(cls)
    scope = dict(vars(module)) if module else {}
    found = {}
    for name, parameter in _parameters(cls).items():
        annotation = parameter.annotation
        if isinstance(annotation, str):
            try:
                annotation = eval(annotation, scope)
            except NameError:
                continue
        if annotation is not parameter.empty:
            found[name] = annotation
    return found


def _argument(value: object, wanted: object, key: str, plugins: Sequence[str]) -> object:
    made = _nested(value, key, plugins)
    try:
        return coerce(made, wanted)
    except MismatchError as err:
        raise ConfigError(f"{key} must be {err}, got {value!r}") from err


def _nested(value: object, key: str, plugins: Sequence[str]) -> object:
    if isinstance(value, Mapping):
        if TARGET in value:
            return build(value, plugins, key)
        return {name: _nested(inner, _join(key, str(name)), plugins) for name, inner in value.items()}
    if isinstance(value, list):
        return [_nested(inner, f"{key}.{index}", plugins) for index, inner in enumerate(value)]
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
