"""The golden values: SHA-256 of what each cell leaves, in a table that can be read.

The last digits of what is driven follow the kernel of the linear algebra and the processor's instructions. So that the
hashes are the same everywhere, a record is hashed with its numbers rounded to four decimals, a trajectory with its
numbers rounded from four decimals to two: to centimetres, since of millions of numbers in tenths of millimetres some
lie where one machine rounds up and another down. ``decisions.py`` compares two checkouts without rounding.
"""

import csv
import hashlib
import json
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

PATH = Path(__file__).resolve().with_name("golden.csv")
FILES = {"record.json": "record", "trajectory.csv": "trajectory", "transcript.jsonl": "text"}
TEXTS = ("asked", "memory")
COLUMNS = ("cell", "of", "record", "trajectory", "text")


_NUMBER = re.compile(rb"-?\d+\.\d{4}")


def _centimetres(number: re.Match[bytes]) -> bytes:
    # Adding zero turns -0.0 into 0.0, which would print differently.
    return b"%.2f" % (round(float(number[0]), 2) + 0.0)


def rounded(value: Any) -> Any:
    """Round all numbers in what JSON can hold to four decimals.

    Args:
        value: What was read from JSON.
    """
    if isinstance(value, dict):
        return {key: rounded(item) for key, item in value.items()}
    if isinstance(value, list):
        return [rounded(item) for item in value]
    return round(value, 4) + 0.0 if isinstance(value, float) else value


def _hash(file: str, content: bytes) -> str:
    """Hash a file, rounded if it is one that is."""
    if file == "record.json":
        content = json.dumps(rounded(json.loads(content)), indent=2, ensure_ascii=False).encode()
    if file == "trajectory.csv":
        content = _NUMBER.sub(_centimetres, content)
    return hashlib.sha256(content).hexdigest()


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
            row[column] = _hash(file, content)
    return sorted(rows.values(), key=lambda row: row["of"])


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
