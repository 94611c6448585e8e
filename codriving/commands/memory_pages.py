"""`codriving memory show`, `search` and `merge`: pages of plain text."""

import textwrap
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from codriving.datatypes import Interaction
from codriving.errors import ConfigError, MemoryFileError
from codriving.memory import Reading, StoredExperience, merge, own_embedder, read_memory, search

WIDTH = 78  # Characters of a line: within the narrowest usual terminal


def show_page(file: Path | None, most: int) -> str:
    """Say what a memory is of.

    Args:
        file: The file; None for the newest one.

    Raises:
        MemoryFileError: If it cannot be read.
    """
    reading = read_memory(_found(file))
    kept = sorted(reading.snapshot.experiences, key=lambda entry: (-entry.count, entry.id))
    lines = [
        str(reading.path),
        f"snapshot      {reading.snapshot.digest}",
        f"embedder      {reading.embedder}, {reading.dimension} numbers",
        f"experiences   {len(kept)}, made {sum(entry.count for entry in kept)} times",
        *_drivers(reading),
        *(f"interactions  {text}" for text in _episodes(reading.interactions)),
        "",
        *_verdicts(reading),
    ]
    if kept:
        lines += ["", "Made most often:", *(text for entry in kept[:most] for text in _entry(entry))]
    return "\n".join(lines)


def _drivers(reading: Reading) -> list[str]:
    """Say what human drivers did who were met, where that was kept."""
    met = reading.snapshot.encounters
    held_back, free = ([one.yielded for one in met if one.relied is relied] for relied in (True, False))
    told = f"{sum(held_back)} of {len(held_back)} whom the rules hold back, {sum(free)} of {len(free)} others"
    return [f"let pass      {told}"] if met else []


def search_page(text: str, file: Path | None, most: int) -> str:
    """Say what in a memory speaks of some words.

    Args:
        file: The file; None for the newest one.

    Raises:
        ConfigError: If there are no words.
        MemoryFileError: If it cannot be read.
    """
    if not any(c.isalnum() for c in text):
        raise ConfigError(f"there is nothing to search for in {text!r}; give some words")
    reading = read_memory(_found(file))
    hits = search(reading.snapshot, text, most)
    if not hits:
        return f"Nothing in {reading.path} speaks of that."
    return "\n".join([str(reading.path), *(t for score, entry in hits for t in _entry(entry, f"{score:.2f}  "))])


def merge_page(first: Path, second: Path, out: Path | None, duplicates: float) -> str:
    """Merge two memories and say what became of them.

    Args:
        out: The file to make; None for one beside the first.

    Raises:
        MemoryFileError: If one of them cannot be used.
    """
    one, other = read_memory(first), read_memory(second)
    if one.embedder != other.embedder:
        raise MemoryFileError(
            f"{first} was made with the embedder {one.embedder} and {second} with {other.embedder}; only memories of "
            "one embedder can be merged"
        )
    target = out or first.with_name(f"{first.stem}+{second.stem}.sqlite")
    interactions = merge([first, second], target, own_embedder(one), duplicates)
    made = read_memory(target)
    before = len(one.snapshot) + len(other.snapshot)
    return (
        f"{target}: {len(made.snapshot)} experiences of {before}, from {interactions} interactions, "
        f"snapshot {made.snapshot.digest[:12]}"
    )


def _found(file: Path | None) -> Path:
    """The file, or the newest below ``outputs/``."""
    if file is not None:
        return file
    there = sorted(Path("outputs").glob("*/*/memory/*.sqlite"), key=lambda path: (path.stat().st_mtime_ns, str(path)))
    if not there:
        raise MemoryFileError("there is no memory below outputs/; name a file, or make one with codriving memory build")
    return there[-1]


def _episodes(interactions: Sequence[Interaction]) -> list[str]:
    """The episodes by what they were of."""
    groups: dict[tuple[str, str, str, str], list[int]] = {}
    for i in interactions:
        groups.setdefault((i.scenario, i.method, i.variant, i.reasoner), []).append(i.seed)
    return [
        f"{len(seeds)} of {scenario}, {f'{method} {variant}'.strip()}, reasoner {reasoner}, "
        f"seeds {min(seeds)} to {max(seeds)}"
        for (scenario, method, variant, reasoner), seeds in groups.items()
    ] or ["none"]


def _verdicts(reading: Reading) -> list[str]:
    counted: Counter[tuple[str, str]] = reading.verdicts
    actions = sorted({action for _, action in counted})
    if not actions:
        return ["Nothing was worth keeping."]
    verdicts = sorted({verdict for verdict, _ in counted})
    rows = [["", *actions], *([v, *(str(counted[v, action]) for action in actions)] for v in verdicts)]
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    return [
        "  ".join([row[0].ljust(widths[0]), *(t.rjust(w) for t, w in zip(row[1:], widths[1:], strict=True))]).rstrip()
        for row in rows
    ]


def _entry(kept: StoredExperience, before: str = "") -> list[str]:
    e = kept.experience
    head = f"{before}#{kept.id}, {kept.count} times, {e.action}: {e.verdict}"
    body = textwrap.wrap(f"{e.description.text} {e.lesson}", WIDTH, initial_indent="    ", subsequent_indent="    ")
    return [head, *body]
