"""The memory of a cell: a snapshot is noted by what it holds, and one that learns grows in the run folder."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from codriving.config.build import build
from codriving.experiment.nodes import holds, replaced

MEMORIES = "memory"
"""Folder, in the run folder, of the memories that grow in it; one file a cell."""

AUTO = "auto"


def pinned(resolved: Mapping[str, Any]) -> dict[str, Any]:
    """Note in a config what the snapshot of its memory holds, so that no other is taken for it later.

    Returns:
        The config with the SHA-256 of the snapshot in place of ``auto``.

    Raises:
        UserError: If the snapshot cannot be read.
    """
    node = resolved["memory"]
    if node is None or node.get("snapshot") != AUTO or not holds(resolved["method"], node):
        return dict(resolved)
    digest = build(node, resolved["plugins"], "memory").digest
    return _with(resolved, node, {**node, "snapshot": digest})


def learns(resolved: Mapping[str, Any]) -> bool:
    """Tell whether the episodes of a cell learn from one another, so that they have to be driven in order."""
    node = resolved.get("memory")
    if node is None or not holds(resolved.get("method"), node):
        return False
    return bool(getattr(build(node, resolved["plugins"], "memory"), "learns", False))


def growing(resolved: Mapping[str, Any], run: Path, cell: str) -> dict[str, Any]:
    """Give a memory that learns its file in the run folder, unless its config names one."""
    if not learns(resolved) or resolved["memory"].get("file") is not None:
        return dict(resolved)
    node = resolved["memory"]
    return _with(resolved, node, {**node, "file": str(memory_file(run, cell))})


def memory_file(run: Path, cell: str) -> Path:
    """Give the file of the memory that grew in a run."""
    return run / MEMORIES / f"{cell}.sqlite"


def _with(resolved: Mapping[str, Any], old: Mapping[str, Any], new: Mapping[str, Any]) -> dict[str, Any]:
    return {**resolved, "memory": new, "method": replaced(resolved["method"], old, new)}
