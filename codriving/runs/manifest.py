"""``manifest.json``: what a run was made of and with; nothing in it comes from the environment's variables."""

import json
from dataclasses import dataclass
from pathlib import Path

from codriving.errors import RunFolderError
from codriving.runs.json_files import decode, encode

MANIFEST = "manifest.json"
FORMAT = 2
"""Layout of the run folder; raised when an older reader could no longer read a newer folder."""


@dataclass(frozen=True, slots=True)
class CellEntry:
    """One cell of the run: one config on many seeds.

    Attributes:
        folder: Name of its folder under ``episodes/``.
        reasoner: Who reasons: ``rules`` or the name of a model.
    """

    folder: str
    scenario: str
    method: str
    variant: str
    reasoner: str
    fingerprint: str
    swept: dict[str, str]
    settings: dict[str, str]


@dataclass(frozen=True, slots=True)
class Manifest:
    """What a run was made of and with.

    Attributes:
        commit: Commit of the checkout, with ``+changes`` if it was not clean; None for an installed package.
    """

    format: int
    experiment: str
    created: str
    first_seed: int
    episodes: int
    rows: tuple[str, ...]
    cells: tuple[CellEntry, ...]
    versions: dict[str, str]
    commit: str | None
    machine: dict[str, str]


def manifest_text(manifest: Manifest) -> str:
    """Give the content of ``manifest.json``."""
    return encode(manifest)


def read_manifest(folder: Path) -> Manifest | None:
    """Read the manifest of a run folder.

    Returns:
        The manifest, or None if there is none.

    Raises:
        RunFolderError: If it is damaged or cannot be read.
    """
    path = folder / MANIFEST
    try:
        return decode(Manifest, _of_this_layout(path.read_text(encoding="utf-8")))
    except FileNotFoundError:
        return None
    except OSError as error:
        raise RunFolderError(f"cannot read {path}: {error.strerror}; check its permissions") from error
    except ValueError as error:
        raise RunFolderError(
            f"{path} is damaged ({error}), so nobody can tell what config the run is of; start a new one with "
            "another run=<name>: the episodes in the old folder stay readable"
        ) from error


def _of_this_layout(text: str) -> str:
    """Fill in what layout 1 had not: its cells were all rows, and none was of a sweep."""
    plain = json.loads(text)
    if not isinstance(plain, dict) or plain.get("format") != 1:
        return text
    cells = plain["cells"]
    upgraded = [{**cell, "swept": {}} for cell in cells]
    return json.dumps({**plain, "rows": [cell["folder"] for cell in cells], "cells": upgraded})
