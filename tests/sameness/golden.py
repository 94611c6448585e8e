"""The golden values: SHA-256 of what each cell leaves, in a table that can be read."""

import csv
import hashlib
from collections.abc import Iterable, Mapping
from pathlib import Path

PATH = Path(__file__).resolve().with_name("golden.csv")
FILES = {"record.json": "record", "trajectory.csv": "trajectory", "transcript.jsonl": "text"}
TEXTS = ("asked", "memory")
COLUMNS = ("cell", "of", "record", "trajectory", "text")


def rows_of(cell: str, left: Mapping[str, bytes]) -> list[dict[str, str]]:
    """Make the rows of a cell.

    Args:
        cell: Its name.
        left: What it has left, by name.

    Returns:
        One row an episode, with its hashes; and one for what a model was asked, and for the texts of a memory.
    """
    rows: dict[str, dict[str, str]] = {}
    for name, content in left.items():
        of, _, file = name.rpartition("/")
        column = FILES.get(file, "text" if name in TEXTS else "")
        if column:
            row = rows.setdefault(of or name, {**dict.fromkeys(COLUMNS, ""), "cell": cell, "of": of or name})
            row[column] = hashlib.sha256(content).hexdigest()
    return list(rows.values())


def read() -> dict[str, list[dict[str, str]]]:
    """Read the golden values: rows by the name of the cell."""
    table: dict[str, list[dict[str, str]]] = {}
    with PATH.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            table.setdefault(row["cell"], []).append(row)
    return table


def write(rows: Iterable[Mapping[str, str]]) -> None:
    """Write the golden values."""
    with PATH.open("w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        table.writeheader()
        table.writerows(rows)


def differences(cell: str, left: Mapping[str, bytes], golden: Iterable[Mapping[str, str]]) -> list[str]:
    """Compare what a cell has left with its golden values.

    Args:
        cell: Its name.
        left: What it has left, by name.
        golden: Its golden rows.

    Returns:
        What differs, a line each.
    """
    now = {row["of"]: row for row in rows_of(cell, left)}
    then = {row["of"]: row for row in golden}
    lines = [f"{cell}, {of}: there before, not now" for of in then if of not in now]
    lines += [f"{cell}, {of}: there now, not before" for of in now if of not in then]
    for of in (of for of in then if of in now):
        lines += [f"{cell}, {of}: {column} differs" for column in COLUMNS[2:] if then[of][column] != now[of][column]]
    return lines
