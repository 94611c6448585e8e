"""The content of the files that the config of a cell names: templates, weights, its memory, plug-ins of the user's."""

from collections.abc import Iterator, Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from codriving.runs import MEMORY, NamedFile, driving_values, files_of, flat, snapshot_of


def contents(resolved: Mapping[str, Any], own: Mapping[str, Path]) -> tuple[NamedFile, ...]:
    """Read what a cell is told by beside names and values."""
    sources = {f"plug-in {name}": path for plugin in resolved["plugins"] for name, path in _sources(plugin)}
    named = {key: path for key, path in _values(resolved).items() if path not in own.values()}
    return files_of({**named, **own, **sources}) + snapshot_of(resolved)


def _values(resolved: Mapping[str, Any]) -> dict[str, Path]:
    """Values that are names of files; a memory grows, unless its snapshot tells it."""
    nodes = {key: node for key, node in driving_values(resolved).items() if isinstance(node, Mapping) and key != MEMORY}
    texts = {key: text[1:-1] for key, text in flat(nodes).items() if text.startswith('"')}
    return {key: path for key, text in texts.items() if text and (path := Path(text).expanduser()).is_file()}


def _sources(plugin: str) -> Iterator[tuple[str, Path]]:
    """The modules of a package, or the one file that a module is."""
    spec = find_spec(plugin)
    folders = list(spec.submodule_search_locations or ()) if spec else []
    for folder in map(Path, folders):
        for path in sorted(folder.rglob("*.py")):
            yield f"{plugin}/{path.relative_to(folder).as_posix()}", path
    if spec and not folders and spec.origin and Path(spec.origin).is_file():
        yield Path(spec.origin).name, Path(spec.origin)
