"""``manifest.json``: what a run was made of and with; nothing in it comes from the environment's variables.

It names no class and no plug-in, so that reading a folder never chooses code.
"""

import json
import re
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from codriving.errors import RunFolderError
from codriving.runs.identity import NEW_WORLD, CellEntry, settings_of, snapshot_of
from codriving.runs.json_files import decode, parse_json
from codriving.runs.redaction import nested

MANIFEST = "manifest.json"
# No separator of any system, no drive, no stream, nothing hidden, and no end that Windows drops.
_FOLDER = re.compile(r'[^./\\:*?"<>|][^/\\:*?"<>|]{0,254}(?<![. ])')

FORMAT = 3  # Layout of the run folder; raised when an older reader could no longer read a newer folder


@dataclass(frozen=True, slots=True)
class Manifest:
    """What a run was made of and with."""

    format: int
    behaviour: int  # Behaviour number of the version that drives in it
    experiment: str
    created: str
    first_seed: int
    episodes: int
    rows: tuple[str, ...]  # Folders of the cells that were asked for last
    cells: tuple[CellEntry, ...]
    versions: dict[str, str]
    commit: str | None  # Commit of the checkout, with ``+changes`` if it was not clean; None for an installed package
    machine: dict[str, str]


def read_manifest(folder: Path) -> Manifest | None:
    """Read the manifest of a run folder.

    Returns:
        The manifest, or None if there is none.

    Raises:
        RunFolderError: If it is damaged, of a later version, or cannot be read.
    """
    path = folder / MANIFEST
    try:
        plain = parse_json(path.read_text(encoding="utf-8"))
        layout = plain.get("format") if isinstance(plain, dict) else None
        if isinstance(layout, int) and layout > FORMAT:
            raise RunFolderError(
                f"{folder} was written by a later version (layout {layout}, not {FORMAT}); update first"
            )
        manifest = decode(Manifest, json.dumps(_of_release_0_1(plain) if layout in (1, 2) else plain))
        folders = [cell.folder for cell in manifest.cells]
        for name in folders:
            if not name.isprintable() or not _FOLDER.fullmatch(name):
                raise ValueError(f"{name!a} is no name of a folder")
        if len(folders) != len({name.casefold() for name in folders}) or not set(manifest.rows) <= set(folders):
            raise ValueError("its rows are not its cells")
        for cell in manifest.cells:
            nested(cell.settings)
    except FileNotFoundError:
        return None
    except OSError as error:
        raise RunFolderError(f"cannot read {path}: {error.strerror}; check its permissions") from error
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise RunFolderError(
            f"{path} is damaged ({error}), so that it does not tell what config the run is of; start a new one with "
            "another run=<name>: the episodes in the old folder stay readable"
        ) from error
    return manifest


def only_old_world(output: Path) -> bool:
    """Tell whether there are runs below an output folder, and all of them of before the default world changed."""
    manifests = sorted(output.glob(f"*/*/{MANIFEST}"), reverse=True)  # Of runs named by their time the newest first
    return bool(manifests) and all(_behaviour(path) < NEW_WORLD for path in manifests)


def _behaviour(path: Path) -> int:
    try:
        plain = parse_json(path.read_text(encoding="utf-8"))
        return int(plain.get("behaviour", 1)) if isinstance(plain, dict) else NEW_WORLD
    except (OSError, ValueError, TypeError, RecursionError):
        return NEW_WORLD  # Of what cannot be read nothing is said


def _of_release_0_1(plain: dict[str, Any]) -> dict[str, Any]:
    """Read layout 2, and layout 1, whose cells were all rows and none of a sweep."""
    rows = plain.get("rows", [cell["folder"] for cell in plain["cells"]])
    cells = [_cell_of_release_0_1({"swept": {}, **cell}) for cell in plain["cells"]]
    return {**plain, "format": FORMAT, "behaviour": 1, "rows": rows, "cells": cells}


def _cell_of_release_0_1(cell: dict[str, Any]) -> dict[str, Any]:
    """Leave out the classes, which took part in its fingerprint."""
    resolved = nested(cell["settings"])
    files = [asdict(file) for file in snapshot_of(resolved)]
    return {**cell, "fingerprint": "", "settings": settings_of(resolved), "choices": {}, "files": files}
