"""Cells with one folder each, whose names a person finds and every file system takes."""

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from codriving.experiment.episodes.unit import Labels
from codriving.experiment.swept import shown_apart

if TYPE_CHECKING:
    from codriving.experiment.cells import Cell

LONGEST = 100
"""Characters of a folder's name; Windows allows 260 for a whole path."""


def folder_name(labels: Labels, swept: Mapping[str, str] | None = None, reasoner: bool = False) -> str:
    """Name the folder of a cell.

    Returns:
        ``<scenario>-<method>-<variant>``, then ``-<key>=<value>`` for each swept key, with everything unusual replaced.
    """
    words = [labels.scenario, labels.method, labels.variant, *([labels.reasoner] if reasoner else [])]
    plain = [re.sub(r"[^A-Za-z0-9._]+", "_", word).lstrip(".") for word in words if word]
    pairs = [f"{key}={_value(value)}" for key, value in (swept or {}).items()]
    return "-".join([*plain, *pairs]).rstrip(".")


def _value(text: str) -> str:
    return re.sub(r"[^A-Za-z0-9._+-]+", "_", text).strip("_") or "_"


def distinct(cells: Sequence["Cell"]) -> tuple["Cell", ...]:
    """Drop cells that are the same config again, and tell the others apart."""
    once: dict[str, Cell] = {}
    for cell in cells:
        once.setdefault(cell.fingerprint, cell)
    shown = shown_apart([(cell.labels, cell.swept) for cell in once.values()])
    told = [replace(cell, swept=swept) for cell, swept in zip(once.values(), shown, strict=True)]
    return tuple(replace(cell, folder=name) for cell, name in zip(told, _folders(told), strict=True))


def _folders(cells: Sequence["Cell"]) -> list[str]:
    """Name each, with no more in the name than it takes to tell it from the others."""
    marks = [cell.fingerprint[:8] for cell in cells]
    names = _apart(
        [folder_name(cell.labels, cell.swept) for cell in cells],
        [folder_name(cell.labels, cell.swept, reasoner=True) for cell in cells],
    )
    short = [
        name if len(name) <= LONGEST else f"{name[: LONGEST - len(mark) - 1]}-{mark}"
        for name, mark in zip(names, marks, strict=True)
    ]
    return _apart(short, [f"{name}-{mark}" for name, mark in zip(short, marks, strict=True)])


def _apart(names: Sequence[str], longer: Sequence[str]) -> list[str]:
    """Give those a longer name that would be one folder, also where case makes no difference."""
    taken = Counter(name.casefold() for name in names)
    return [long if taken[name.casefold()] > 1 else name for name, long in zip(names, longer, strict=True)]


def repeated(cells: Sequence["Cell"]) -> tuple[str, ...]:
    """Say which values of a sweep come to the same config as others, for nobody to look for their rows."""
    first: dict[str, Cell] = {}
    notes: dict[str, None] = {}
    for cell in cells:
        known = first.setdefault(cell.fingerprint, cell)
        ours, theirs = (
            " ".join(f"{key}={one.swept[key]}" for key in cell.swept if cell.swept[key] != known.swept.get(key))
            for one in (cell, known)
        )
        if ours:
            name = f"{cell.labels.method} {cell.labels.variant}".strip()
            notes[f"{name}: {ours} is the same configuration as {theirs} and has no row of its own."] = None
    return tuple(notes)
