"""Manifests and cells to open run folders with."""

from pathlib import Path

from codriving.runs.identity import BEHAVIOUR, CellEntry
from codriving.runs.manifest import Manifest
from codriving.runs.provenance import commit, machine, versions

CONFIGS = {"a-cell": ""}


def cell(fingerprint: str = "f1", **settings: str) -> CellEntry:
    labels = ("intersection", "codriving", "no_negotiation/own_view", "rules")
    return CellEntry("a-cell", *labels, fingerprint, {}, {"seed": "0", **settings}, {"method": "codriving"}, ())


def manifest(*cells: CellEntry) -> Manifest:
    held = cells or (cell(),)
    rows = tuple(entry.folder for entry in held)
    return Manifest(
        3, BEHAVIOUR, "run", "2026-01-01T00:00:00+00:00", 0, 20, rows, held, versions(), commit(), machine()
    )


def files(folder: Path) -> dict[str, bytes]:
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()}
