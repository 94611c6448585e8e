"""Writes the golden values: ``PYTHONPATH=CHECKOUT python tests/sameness/record.py [WORD ...]``.

They were recorded with a checkout of version 0.1, but for the cells in which a later behaviour number drives otherwise.
With words, only the cells in whose name one of them is are recorded anew; a change of the code is no reason to do so
unless it is meant to change what is driven.
"""

import os
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from time import process_time

os.environ["SAMENESS"] = "all episodes"

import hashes
from cells import CELLS
from driving import chosen, drive

import codriving


def main(words: Sequence[str]) -> None:
    """Drive the cells and write the table."""
    print(f"recording {codriving.__file__}")
    kept = hashes.read() if words else {}
    wanted, rows = chosen(words), []
    with tempfile.TemporaryDirectory() as place:
        for k, cell in enumerate(CELLS):
            if cell not in wanted:
                rows += kept.get(cell.name, [])
                continue
            rows += hashes.rows_of(cell.name, drive(cell, Path(place) / str(k)))
            print(f"{process_time():7.1f} s  {cell.name}", flush=True)
    hashes.write(rows)


if __name__ == "__main__":
    main(sys.argv[1:])
