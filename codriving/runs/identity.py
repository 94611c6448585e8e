"""What tells a cell from all others: the names of its YAMLs, their values, and the content of files that these name.

No module path is part of it: a class that moves changes nothing.
"""

import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from codriving.runs.redaction import flat, redact

# The behaviour number: raised by every commit that changes a hash in tests/sameness/golden. A run folder of another
# number is replayed, scored and reported, but not extended. Release 0.1 drives behaviour 1; since 2 a lane change looks
# for vehicles on the far side by how fast they close in. With 3 the default world is another one,
# with 4 passing orders hold zone by zone, and with 5 the negotiated order tells first who is scheduled first.
BEHAVIOUR = 5

NEW_WORLD = 3  # The first number whose default world is not ``suite=paper``

# Keys that do not change what is driven; templates and plug-ins are told by their content, metrics by their scores.
WITHOUT_EFFECT = (
    *("episodes", "workers", "output", "run", "shard", "launcher", "render"),
    *("prompts", "plugins", "metrics"),
)

# Keys of ``llm`` likewise: with them a run goes on after a limit has been raised, or is replayed under its name.
HOW_A_MODEL_IS_ASKED = (
    "attempts",
    "cache",
    "cache_file",
    "deadline",
    "failures_in_a_row",
    "max_concurrency",
    "max_cost",
    "max_tokens_total",
    "api_key_header",
    "fallbacks_at_first",
    "model_prefix",
    "stream",
    "model_file",  # Its content tells it
)

# Settings of ``llm`` that came later, with the values that change nothing: runs of before are gone on with.
_CAME_LATER: dict[str, Any] = {"label": None, "max_tokens_field": "max_tokens", "system_role": "system"}
_CAME_LATER |= {"extra": {}, "headers": {}, "latency": "none", "epoch": 1, "thoughts": False}

# The same for ``memory``.
_RECALLED: dict[str, Any] = {"control": "none"}

# How orders hold came later, too; that they hold otherwise than before is what the behaviour number says.
_HOLDS: dict[str, Any] = {"by_zone": True}

# The same for ``executor``: with these values it minds human drivers as before.
_MINDS: dict[str, Any] = {"humans": "planned", "human_margin": 1.5, **_HOLDS}

# The same for ``scenario``: with these values it is the scene of before.
_SCENES: dict[str, Any] = {"pattern": "random", "row_gap": 14.0, "turns": ["left", "straight", "right"]}
_SCENES |= {"blocked_exit": 0.0, "blocked_room": 7.0, "blind": None}

# Groups whose choice stands for a class; all choices of ``cda`` are one class, so that their values tell them.
CHOICES = ("scenario", "method", "executor", "llm", "memory")

DRIVERS, ENVIRONMENT = "drivers", "environment"  # Drivers are told by their values in the environment, as before

# Without limits a world is that of a run whose config did not know them yet; without a flow, and with the order that is
# negotiated, without a filter, without a channel, or with human drivers judged by the rules of the road, likewise.
LIMITS, FLOW, ORDER, FILTER, V2X, JUDGEMENT = "limits", "flow", "order", "filter", "v2x", "judgement"

THINKING = "thinking"  # Where it takes no time a run is that of before it was known

STEADY = "steady"  # Where it is false a world is that of a run whose config did not know it yet

MEMORY = "memory"
SNAPSHOT, AUTO = "snapshot", "auto"  # Where a memory's snapshot is told by its contents, its file may lie anywhere

# Nodes of the root to which other nodes refer, and which therefore stand in these once more.
_COPIED = (*CHOICES, "cda", LIMITS, FLOW, ORDER, FILTER, V2X, JUDGEMENT)


@dataclass(frozen=True, slots=True)
class NamedFile:
    """A file that the config of a cell names and whose content is part of what the cell is."""

    name: str  # What it is, for instance ``weights`` or ``template decide.user.md.j2``
    path: str
    sha256: str


@dataclass(frozen=True, slots=True)
class CellEntry:
    """One cell of the run: one config on many seeds."""

    folder: str  # Name of its folder under ``episodes/``
    scenario: str
    method: str
    variant: str
    reasoner: str  # What reasons: ``rules`` or the name of a model
    fingerprint: str
    swept: dict[str, str]  # What tells it from other rows of its table
    settings: dict[str, str]  # The values that drive, as JSON by dotted key
    choices: dict[str, str]  # Name of the YAML of each group; empty for a cell of release 0.1
    files: tuple[NamedFile, ...]
    repeatable: bool | None = None  # False where times were measured in it, which no second run measures alike

    @property
    def labels(self) -> tuple[str, str, str, str]:
        """What its records are labelled with: scenario, method, variant, reasoner."""
        return self.scenario, self.method, self.variant, self.reasoner


def driving_values(resolved: Mapping[str, Any]) -> dict[str, Any]:
    """Leave out of a resolved config what does not change what is driven, the names of classes, and repetitions."""
    values = {key: _plain(node, resolved) for key, node in resolved.items() if key not in WITHOUT_EFFECT}
    for key in (LIMITS, FLOW, ORDER, FILTER, V2X, JUDGEMENT):
        if values.get(key) is None:
            values.pop(key, None)
    if isinstance(thinking := values.get(THINKING), Mapping) and not any(thinking.values()):
        values.pop(THINKING)
    environment = values.get(ENVIRONMENT)
    if DRIVERS in values and isinstance(environment, Mapping) and environment.get(DRIVERS) == values[DRIVERS]:
        values.pop(DRIVERS)
    if isinstance(environment, Mapping) and not environment.get(STEADY, True):
        values[ENVIRONMENT] = {name: value for name, value in environment.items() if name != STEADY}
    dropped: dict[str, Sequence[str]] = {"llm": HOW_A_MODEL_IS_ASKED}
    if snapshot_of(resolved):
        dropped[MEMORY] = (SNAPSHOT, "file")
    for key, names in dropped.items():
        if isinstance(node := values.get(key), Mapping):
            values[key] = {name: value for name, value in node.items() if name not in names}
    came_later = {"llm": _CAME_LATER, "scenario": _SCENES, "executor": _MINDS, "method": _HOLDS, MEMORY: _RECALLED}
    for key, later in came_later.items():
        if isinstance(node := values.get(key), Mapping):
            values[key] = {name: value for name, value in node.items() if (name, value) not in later.items()}
    return values


def _plain(node: object, resolved: Mapping[str, Any]) -> object:
    if isinstance(node, list):
        return [_plain(item, resolved) for item in node]
    if not isinstance(node, Mapping):
        return node
    return {
        name: _plain(value, resolved)
        for name, value in node.items()
        if name != "_target_"
        and not _tells_how(str(name))
        and not (name in _COPIED and name in resolved and value == resolved[name])
    }


def _tells_how(name: str) -> bool:
    """Whether a key names the environment variable of a key, or how long a server may take."""
    return name.endswith("_env") or name == "embedding_deadline"


def snapshot_of(resolved: Mapping[str, Any]) -> tuple[NamedFile, ...]:
    """Return the snapshot that a memory is told by, if it is."""
    memory = resolved.get(MEMORY) or {}
    digest = memory.get(SNAPSHOT, AUTO)
    return () if digest == AUTO else (NamedFile(MEMORY, str(memory.get("file") or ""), str(digest)),)


def files_of(paths: Mapping[str, Path]) -> tuple[NamedFile, ...]:
    """Read the content of files, by what they are.

    Raises:
        OSError: If one cannot be read.
    """
    return tuple(
        NamedFile(name, _shown(path), _digest(path, path.stat().st_size, path.stat().st_mtime_ns))
        for name, path in paths.items()
    )


@lru_cache(maxsize=256)
def _digest(path: Path, size: int, changed: int) -> str:
    """Read a file once, however many cells name it; a model may have gigabytes."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _shown(path: Path) -> str:
    """A path without the folder in which we, or the user, are at home."""
    for home in (Path.cwd(), Path(__file__).resolve().parents[2]):
        if path.is_relative_to(home):
            return path.relative_to(home).as_posix()
    return str(path)


def fingerprint(
    names: Sequence[str], choices: Mapping[str, str], resolved: Mapping[str, Any], files: Iterable[NamedFile]
) -> str:
    """Reduce to one text what tells a cell.

    Args:
        names: What its objects call themselves: scenario, method, variant, reasoner.
        choices: Name of the YAML of each group.
    """
    values = driving_values(resolved)
    # Where an order or a filter is chosen its name stands for a class, too: a plug-in may have no settings.
    groups = (*CHOICES, *(group for group in (ORDER, FILTER, V2X, JUDGEMENT) if group in values))
    told = {
        "names": list(names),
        "choices": {group: choices[group] for group in groups if group in choices},
        "values": values,
        "files": {file.name: file.sha256 for file in files},
    }
    text = json.dumps(told, sort_keys=True, separators=(",", ":"), ensure_ascii=True, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()


def settings_of(resolved: Mapping[str, Any]) -> dict[str, str]:
    """Return what drives, without secrets, as JSON by dotted key."""
    return flat(redact(driving_values(resolved)))


def same_cell(there: CellEntry, here: CellEntry) -> bool:
    """Tell whether a cell of a run folder is the cell that is asked for.

    Of a cell of release 0.1 neither choices nor files are known, but for the snapshot of its memory.
    """
    if there.choices:
        return there.fingerprint == here.fingerprint
    known = {file.name: file.sha256 for file in there.files}
    return same_settings(there, here) and known.items() <= {file.name: file.sha256 for file in here.files}.items()


def same_settings(there: CellEntry, here: CellEntry) -> bool:
    """Tell whether two cells have the same names and values, whatever is in the files that these name."""
    same = (there.labels, there.settings) == (here.labels, here.settings)
    return same and all(there.choices.get(g, name) == name for g, name in here.choices.items() if g in CHOICES)


def changed_files(there: CellEntry, here: CellEntry) -> Iterator[str]:
    """Name the files of a cell that hold something else than when it was driven, or were not there."""
    before, now = ({file.name: file for file in cell.files} for cell in (there, here))
    for name in sorted(before.keys() | now.keys()) if there.choices else ():
        was, is_ = before.get(name), now.get(name)
        if was is None or is_ is None:
            yield f"{(was or is_).path} ({name}) was {'added' if was is None else 'removed'}"  # type: ignore[union-attr]
        # A memory of another name is another memory.
        elif was.sha256 != is_.sha256 and (name != MEMORY or was.path == is_.path):
            yield f"{is_.path} ({name}) has changed"
