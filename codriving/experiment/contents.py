"""The content of the files that the config of a cell names: templates, weights, its memory, plug-ins of the user's."""

import ast
from collections.abc import Iterator, Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from codriving.runs import MEMORY, NamedFile, driving_values, files_of, snapshot_of


def contents(resolved: Mapping[str, Any], own: Mapping[str, Path]) -> tuple[NamedFile, ...]:
    """Read what a cell is told by beside names and values."""
    sources = {f"plug-in {name}": path for plugin in resolved["plugins"] for name, path in _sources(plugin)}
    named = {key: path for key, path in _values(resolved).items() if path not in own.values()}
    return files_of({**named, **own, **sources}) + snapshot_of(resolved)


def _values(resolved: Mapping[str, Any]) -> dict[str, Path]:
    """Values that are names of files, in lists too; a memory grows, unless its snapshot tells it."""
    nodes = {key: node for key, node in driving_values(resolved).items() if isinstance(node, Mapping) and key != MEMORY}
    return {key: path for key, text in _texts(nodes) if text and (path := Path(text).expanduser()).is_file()}


def _texts(node: object, key: str = "") -> Iterator[tuple[str, str]]:
    if isinstance(node, str):
        yield key, node
    for name, value in node.items() if isinstance(node, Mapping) else enumerate(node) if isinstance(node, list) else ():
        yield from _texts(value, f"{key}.{name}" if key else str(name))


def _sources(plugin: str) -> Iterator[tuple[str, Path]]:
    """The modules of a package or the one file that a module is, and those beside it that they import."""
    names, seen = [plugin.partition(".")[0]], set[str]()
    spec = find_spec(names[0])
    place = spec.origin or next(iter(spec.submodule_search_locations or ()), None) if spec else None
    if place is None or not Path(place).exists():
        return
    beside = Path(place).parent.parent if Path(place).name == "__init__.py" else Path(place).parent
    while names:
        name = names.pop()
        seen.add(name)
        for path in _files(beside, name):
            yield path.relative_to(beside).as_posix(), path
            names += [other for other in _imported(path) if other not in seen and any(_files(beside, other))]


def _files(beside: Path, name: str) -> Iterator[Path]:
    if (alone := beside / f"{name}.py").is_file():
        yield alone
    yield from sorted((beside / name).rglob("*.py"))


def _imported(path: Path) -> Iterator[str]:
    """The packages that a module imports by their full names."""
    try:
        tree = ast.parse(path.read_bytes())
    except (SyntaxError, ValueError):
        return
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name.partition(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            yield node.module.partition(".")[0]
