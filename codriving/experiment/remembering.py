"""The memory of a cell: a snapshot is noted by what it holds, and one that learns grows in the run folder."""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from codriving.experiment.objects import memory_of
from codriving.memory import read_memory

MEMORIES = "memory"  # Folder, in the run folder, of the memories that grow in it; one file a cell

AUTO = "auto"

FEW = 10  # Of fewer experiences nothing can be said


def pinned(resolved: Mapping[str, Any]) -> dict[str, Any]:
    """Note in a config what the snapshot of its memory holds, so that no other is taken for it later."""
    node = resolved["memory"]
    memory = memory_of(resolved) if node is not None and node.get("snapshot") == AUTO else None
    return dict(resolved) if memory is None else {**resolved, "memory": {**node, "snapshot": memory.digest}}


def prepare(configs: Iterable[Mapping[str, Any]]) -> None:
    """Try the memory of each cell before anything is driven, its file and what turns situations into vectors."""
    for config in configs:
        if (memory := memory_of(config)) is not None:
            memory.prepare()


def learns(resolved: Mapping[str, Any]) -> bool:
    """Tell whether the episodes of a cell learn from one another, so that they have to be driven in order."""
    return (memory := memory_of(resolved)) is not None and memory.learns


def growing(resolved: Mapping[str, Any], run: Path, cell: str) -> dict[str, Any]:
    """Give a memory that learns its file in the run folder, unless its config names one."""
    if not learns(resolved) or resolved["memory"].get("file") is not None:
        return dict(resolved)
    return {**resolved, "memory": {**resolved["memory"], "file": str(memory_file(run, cell))}}


def merged_notes(configs: Iterable[Mapping[str, Any]]) -> Iterator[str]:
    """Say of which memory more than half of what was experienced is not told apart."""
    for config in configs:
        node = config["memory"] or {}
        if not learns(config) or "duplicates" not in node or not (path := Path(node["file"]).expanduser()).exists():
            continue
        kept = read_memory(path).snapshot.experiences
        made = sum(entry.count for entry in kept)
        if made >= FEW and 2 * len(kept) < made:
            yield (
                f"{path}: of {made} experiences only {len(kept)} are kept, since the others are too like one of them; "
                f"raise memory.duplicates, which is {node['duplicates']}, or choose another memory.embedder, and build "
                "it again"
            )


def memory_file(run: Path, cell: str) -> Path:
    """Give the file of the memory that grew in a run."""
    return run / MEMORIES / f"{cell}.sqlite"
