"""Packages of the user's: which ones a config names, and where they may stand."""

import sys
from collections.abc import Mapping, Sequence
from importlib.machinery import PathFinder
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from codriving.config.schema import ROOT
from codriving.errors import ConfigError

PLUGINS = "plugins"  # The key of the root; a YAML that holds a ``_target_`` may have it, too, for what it names itself


def gathered(resolved: Mapping[str, Any]) -> dict[str, Any]:
    """Take the key ``plugins`` out of every node and add what it lists to that of the root.

    So a YAML of the user's says itself what it needs, and in a sweep each cell has what its own files ask for.
    """
    found: list[str] = []
    nodes = {n: node if n == PLUGINS else _without(node, str(n), found) for n, node in resolved.items()}
    if found and isinstance(own := nodes.get(PLUGINS), list):
        nodes[PLUGINS] = list(dict.fromkeys([*own, *found]))
    return nodes


def _without(node: object, key: str, found: list[str]) -> object:
    if isinstance(node, list):
        return [_without(inner, f"{key}.{index}", found) for index, inner in enumerate(node)]
    if not isinstance(node, Mapping):
        return node
    if "_target_" in node and PLUGINS in node:
        if not ROOT[PLUGINS].allows(node[PLUGINS]):
            raise ConfigError(f"{key}.{PLUGINS} must be {ROOT[PLUGINS].rule}, got {node[PLUGINS]!r}")
        found += node[PLUGINS]
        node = {name: value for name, value in node.items() if name != PLUGINS}
    return {name: _without(inner, f"{key}.{name}", found) for name, inner in node.items()}


def find_beside(plugins: Sequence[str], config_dir: Path | None) -> None:
    """Let packages that stand beside the user's config folder be imported.

    The folder goes to the end of the search path, so that it hides nothing, and only if it holds a package that is
    listed and not to be found otherwise. Worker processes are given the same search path.
    """
    if config_dir is None:
        return
    folder = str(config_dir.absolute().parent)
    missing = {name.partition(".")[0] for name in plugins} - set(sys.modules)
    if folder not in sys.path and any(find_spec(n) is None and PathFinder.find_spec(n, [folder]) for n in missing):
        sys.path.append(folder)


def refuse_missing(plugins: Sequence[str]) -> None:
    """Refuse a package that is listed and not there, though no class of it may be named yet.

    Raises:
        ConfigError: With the name of the first.
    """
    for name in (name.partition(".")[0] for name in plugins):
        if name not in sys.modules and find_spec(name) is None:
            raise ConfigError(
                f"plugins: there is no module {name}; install it, or put it beside the folder that --config-dir names"
            )
