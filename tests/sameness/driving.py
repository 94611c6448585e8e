"""Drives cells as ``python -m codriving`` does, in this process, and gives what they leave.

By hand, in a process whose search path begins with the checkout that is to be driven:
``PYTHONPATH=CHECKOUT python tests/sameness/driving.py FOLDER [WORD ...]`` drives all cells, or those in whose name one
of the words is, and leaves their files below FOLDER.
"""

import contextlib
import io
import json
import re
import runpy
import shutil
import sqlite3
import sys
from collections.abc import Sequence
from pathlib import Path
from unittest.mock import patch

from cells import CELLS, MEMORY, Cell
from model import Model

HERE = Path(__file__).resolve().parent

TEXTS = {
    "interactions": "scenario, seed, method, variant, reasoner",
    "experiences": "action, verdict, scene, conflict, passing, kinds, lesson",
    "sightings": "experience, interaction, step, ego",
}
"""What is compared of a memory. Vectors and effects are left out: their last digits may depend on the machine."""

SECONDS = re.compile(rb'("(?:model_)?seconds": )[0-9.e+-]+')
"""The only thing in a record (``counts.model_seconds``) and in a transcript (``seconds``) that the clock decides."""

NUMBERS = "id, numbers, effect, vector"
"""What is compared of its experiences besides on one machine."""


def codriving(*typed: str) -> tuple[int, str]:
    """Run a command as a user would.

    Args:
        *typed: What comes after ``codriving``.

    Returns:
        Exit code, and what was printed.
    """
    said, code = io.StringIO(), 0
    printing = contextlib.redirect_stdout(said), contextlib.redirect_stderr(said)
    with patch.object(sys, "argv", ["codriving", *typed]), printing[0], printing[1]:
        try:
            runpy.run_module("codriving", run_name="__main__", alter_sys=True)
        except SystemExit as ended:
            code = int(ended.code or 0)
    return code, said.getvalue()


def drive(cell: Cell, place: Path) -> dict[str, bytes]:
    """Drive a cell and give what it leaves that may not depend on the clock.

    Args:
        cell: The cell.
        place: A folder to drive in.

    Returns:
        Contents by name: ``<variant>/<seed>/<file>`` if there are several variants, else ``<seed>/<file>``; besides
        ``asked`` of a model, and of each memory ``memory`` and ``memory numbers``.

    Raises:
        RuntimeError: If the command fails.
    """
    place.mkdir(parents=True, exist_ok=True)
    shutil.copy(HERE / MEMORY, place)
    with contextlib.chdir(place), contextlib.ExitStack() as stack:
        model = stack.enter_context(Model()) if cell.model else None
        code, said = codriving(*cell.typed, *(model.overrides if model else ()), "run=x")
    if code:
        raise RuntimeError(f"{cell.name}: codriving {' '.join(cell.typed)} ended with {code}: {said}")
    [folder] = place.glob("outputs/*/x")
    left = episodes(folder)
    if model:
        left["asked"] = model.asked.encode()
    for path in folder.glob("memory/*.sqlite"):
        left["memory"], left["memory numbers"] = learnt(path)
    return left


def episodes(folder: Path) -> dict[str, bytes]:
    """Read the files of the episodes of a run folder.

    Args:
        folder: The run folder.

    Returns:
        Contents by name, without what depends on the clock: the seconds are ``null``.
    """
    left = {}
    rows = sorted(folder.glob("episodes/*"))
    for row in rows:
        for path in sorted(row.glob("*/*")):
            if path.name in ("timing.json", "SHA256SUMS"):
                continue
            variant = json.loads((path.parent / "record.json").read_text())["variant"]
            begin = f"{variant}: " if len(rows) > 1 else ""
            left[f"{begin}{path.parent.name}/{path.name}"] = comparable(path)
    return left


def comparable(path: Path) -> bytes:
    """Read a file of an episode without what depends on the clock, and of a record what was driven, not how it scored.

    Scores are worked out of the trajectory and have tests of their own; a metric may gain numbers.
    Styles of drivers, which version 0.1 did not know, are left out where there are none.

    Args:
        path: The file.
    """
    content = SECONDS.sub(rb"\1null", path.read_bytes())
    if path.name != "record.json":
        return content
    record = {key: value for key, value in json.loads(content).items() if key not in ("score", "scores")}
    for participant in record["participants"]:
        if participant.get("style") == "":
            del participant["style"]
    return (json.dumps(record, indent=2, ensure_ascii=False) + "\n").encode()


def learnt(path: Path) -> tuple[bytes, bytes]:
    """Read a file of memories.

    Args:
        path: The file.

    Returns:
        Its texts, and its numbers.
    """
    with contextlib.closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True)) as file:
        texts = [
            row
            for table, columns in TEXTS.items()
            for row in file.execute(f"SELECT {columns} FROM {table} ORDER BY {columns}")
        ]
        numbers = file.execute(f"SELECT {NUMBERS} FROM experiences ORDER BY id").fetchall()
    lines = [json.dumps(row) for row in texts]
    return "\n".join(lines).encode(), repr(numbers).encode()


def chosen(words: Sequence[str]) -> list[Cell]:
    """The cells in whose name one of some words is; all if there are none."""
    return [cell for cell in CELLS if not words or any(word in cell.name for word in words)]


def main(arguments: Sequence[str]) -> None:
    """Drive cells and leave their files, each cell in a folder of its own."""
    import codriving as package

    folder, words = Path(arguments[0]).resolve(), arguments[1:]
    print(f"driving {package.__file__}", flush=True)
    for k, cell in enumerate(chosen(words)):
        place = folder / "places" / str(k)
        for name, content in drive(cell, place).items():
            path = folder / "left" / cell.name / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        shutil.rmtree(place)


if __name__ == "__main__":
    main(sys.argv[1:])
