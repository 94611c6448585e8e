"""What tells an object of the user's from all others: its values, and the code that it runs, also what that names."""

import dis
import hashlib
import inspect
import json
import sys
import sysconfig
from collections.abc import Iterator, Mapping
from enum import Enum
from functools import cached_property, partial
from pathlib import Path, PurePath
from types import BuiltinFunctionType, CodeType, FunctionType, MethodType, ModuleType
from typing import Any

from codriving.errors import ConfigError

IDENTITY = "identity"  # Attribute by which a user says it, where it cannot be read off the object

_CURE = (
    f"{{}} holds {{}}, which cannot be told from another one{{}}; give it an attribute {IDENTITY}, a text that changes "
    "whenever it drives differently"
)

_HERE = Path(__file__).resolve().parents[1]
_INSTALLED = [Path(sysconfig.get_path(name)).resolve() for name in ("stdlib", "platstdlib", "purelib", "platlib")]

_STARS = inspect.CO_VARARGS | inspect.CO_VARKEYWORDS

# Of a class: what Python adds itself, and what changes nothing.
_ADDED = {
    *("__module__", "__qualname__", "__doc__", "__dict__", "__weakref__", "__annotations__", "__abstractmethods__"),
    *("_abc_impl", "__firstlineno__", "__static_attributes__", "__annotate_func__", "__annotations_cache__"),
    *("__match_args__", "__dataclass_params__", "__dataclass_fields__", "__parameters__", "__orig_bases__"),
}


def identity_of(thing: object) -> str:
    """Give the SHA-256 of what an object, or a class, is and does.

    Code is told by its bytecode, so that comments, line numbers and the words of a docstring do not matter; another
    version of Python may give another text. What the code names in its module and is the user's is told with it;
    libraries are told by name.

    Raises:
        ConfigError: If it holds what cannot be told.
    """
    said = vars(thing).get(IDENTITY) if isinstance(thing, type) else getattr(thing, IDENTITY, None)
    if said is not None and not isinstance(said, str):
        raise ConfigError(f"{IDENTITY} of {name_of(thing)} must be a text, got {said!r:.100}")
    told = [name_of(thing), said] if said is not None else _described(thing)
    return hashlib.sha256(json.dumps(told, separators=(",", ":")).encode()).hexdigest()


def _described(thing: object) -> Any:  # noqa: ANN401
    try:
        return _Description(name_of(thing)).of(thing)
    except RecursionError as error:
        raise ConfigError(_CURE.format(name_of(thing), "what nests too deep", "")) from error


def name_of(thing: object) -> str:
    """Name the class of an object, or a class."""
    return (thing if isinstance(thing, type) else type(thing)).__qualname__.rpartition(".")[2]


def is_users(module: str | None) -> bool:
    """Whether a module is neither ours nor of an installed library."""
    top = (module or "").partition(".")[0]
    if top == "__main__":
        return True  # A notebook, whatever runs it
    if top in ("", "codriving") or top in sys.stdlib_module_names:
        return False
    file = getattr(sys.modules.get(module or ""), "__file__", None)
    return file is not None and not any(folder in Path(file).resolve().parents for folder in (_HERE, *_INSTALLED))


def _library_of(bound: BuiltinFunctionType | MethodType) -> str:
    """The library's module of which it is a function, as ``math.sqrt`` is, or ``random.choice`` of a hidden object."""
    held = bound.__self__
    module = held if isinstance(held, ModuleType) else sys.modules.get(type(held).__module__)
    name = str(getattr(module, "__name__", ""))
    return name if not is_users(name) and getattr(module, bound.__name__, None) == bound else ""


class _Description:
    """Writes down one object; what is met again is told by the place at which it was first met."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._met: dict[int, int] = {}
        self._kept: list[object] = []  # Else an id might be given anew

    def of(self, thing: Any) -> Any:  # noqa: ANN401 - any object
        """Write down what a thing is, as JSON."""
        if thing is None or (isinstance(thing, bool | int | str) and type(thing) in (bool, int, str)):
            return thing
        if type(thing) in (float, complex, bytes) or isinstance(thing, PurePath):
            return [type(thing).__name__, repr(thing)]
        if isinstance(thing, tuple | frozenset | CodeType):
            # Whether two that are alike are one object is up to the interpreter.
            return self._told(thing)
        if id(thing) in self._met:
            return ["again", self._met[id(thing)]]
        self._met[id(thing)] = len(self._met)
        self._kept.append(thing)
        return self._told(thing)

    def _told(self, thing: Any) -> Any:  # noqa: ANN401
        if isinstance(thing, Enum):
            return ["member", self.of(type(thing)), thing.name, self.of(thing.value)]
        if isinstance(thing, Mapping) and type(thing) in (dict, type(type.__dict__)):
            return ["mapping", [[self.of(key), self.of(value)] for key, value in thing.items()]]
        if type(thing) in (set, frozenset):
            return ["set", sorted(json.dumps(_Description(self._name).of(one)) for one in thing)]
        if type(thing) in (list, tuple):
            return [type(thing).__name__, [self.of(one) for one in thing]]
        if isinstance(thing, CodeType):
            # The same bytes may catch other errors, or take their arguments otherwise.
            taken = thing.co_argcount, thing.co_kwonlyargcount, thing.co_flags & _STARS, thing.co_exceptiontable.hex()
            constants = [self.of(one) for one in thing.co_consts]
            names = thing.co_names, thing.co_varnames, thing.co_freevars
            return ["code", thing.co_code.hex(), constants, *names, *taken]
        if isinstance(thing, ModuleType):
            return ["module", thing.__name__, self._file(thing) if is_users(thing.__name__) else ""]
        if isinstance(thing, BuiltinFunctionType | MethodType) and (module := _library_of(thing)):
            return ["library", module, thing.__name__]
        if isinstance(thing, BuiltinFunctionType):
            return ["bound", thing.__qualname__, self.of(thing.__self__)]
        if isinstance(thing, type | FunctionType) and not is_users(thing.__module__):
            return ["library", thing.__module__, thing.__qualname__]
        if isinstance(thing, FunctionType):
            return self._function(thing)
        return self._class(thing) if isinstance(thing, type) else self._object(thing)

    def _function(self, function: FunctionType) -> Any:  # noqa: ANN401
        code = _without_docstring(function)
        named = {n: function.__globals__[n] for n in _globals(code) if n in function.__globals__}
        cells = [_content(cell) for cell in function.__closure__ or ()]
        defaults = function.__defaults__, function.__kwdefaults__
        return ["function", *map(self.of, (code, defaults, cells, named, _behind(function)))]

    def _class(self, cls: type) -> Any:  # noqa: ANN401
        own = {name: _plain(value) for name, value in sorted(vars(cls).items()) if name not in _ADDED}
        return ["class", name_of(cls), self.of(type(cls)), [self.of(base) for base in cls.__bases__], self.of(own)]

    def _object(self, thing: Any) -> Any:  # noqa: ANN401
        if isinstance(thing, MethodType):
            return ["method", self.of(thing.__func__), self.of(thing.__self__)]
        if isinstance(thing, partial):
            return ["partial", *map(self.of, (thing.func, thing.args, thing.keywords))]
        try:
            made = thing.__reduce_ex__(4)
        except Exception as error:
            raise ConfigError(_CURE.format(self._name, f"a {name_of(thing)}", f" ({error})")) from error
        if isinstance(made, str):
            return ["named", self.of(type(thing)), made, self.of(_behind(thing))]
        rest = [list(part) if isinstance(part, Iterator) else part for part in made[1:]]
        if len(rest) > 1 and type(rest[1]) is dict:
            rest[1] = {name: rest[1][name] for name in sorted(rest[1], key=str) if not _is_cached(thing, name)}
        return ["object", self.of(type(thing)), [self.of(part) for part in rest]]

    def _file(self, module: ModuleType) -> str:
        try:
            return hashlib.sha256(Path(str(module.__file__)).read_bytes()).hexdigest()
        except OSError:
            return ""


def _globals(code: CodeType) -> list[str]:
    """The names that code, also what is nested in it, takes from its module."""
    found = {str(i.argval) for i in dis.get_instructions(code) if i.opname in ("LOAD_GLOBAL", "LOAD_NAME")}
    for inner in code.co_consts:
        found |= set(_globals(inner)) if isinstance(inner, CodeType) else set()
    return sorted(found)


def _without_docstring(function: FunctionType) -> CodeType:
    code, text = function.__code__, function.__doc__
    is_used = any(i.opcode in dis.hasconst and i.arg == 0 for i in dis.get_instructions(code))
    if text is None or code.co_consts[:1] != (text,) or is_used:
        return code
    return code.replace(co_consts=(None, *code.co_consts[1:]))


def _behind(thing: object) -> dict[str, object]:
    """What ``functools`` keeps of functions that it wraps, as ``cache`` and ``singledispatch`` do."""
    return {name: getattr(thing, name) for name in ("__wrapped__", "registry") if hasattr(thing, name)}


def _is_cached(thing: object, name: str) -> bool:
    return isinstance(inspect.getattr_static(type(thing), name, None), cached_property)


def _content(cell: Any) -> object:  # noqa: ANN401 - its type has no name
    try:
        return cell.cell_contents
    except ValueError:
        return "empty"


def _plain(value: object) -> object:
    """What stands behind a descriptor of a class."""
    if isinstance(value, staticmethod | classmethod):
        return [type(value).__name__, value.__func__]
    if isinstance(value, property):
        return ["property", value.fget, value.fset]
    if isinstance(value, cached_property):
        return ["cached_property", value.func]
    if inspect.ismemberdescriptor(value) or inspect.isgetsetdescriptor(value):
        return "slot"
    return value
