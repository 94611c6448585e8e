"""What human drivers did who were met, in the file of a memory: a table that is made when the first is kept."""

import json
import sqlite3
from collections.abc import Sequence
from math import isfinite

from codriving.datatypes import MetDriver

_TABLE = """
CREATE TABLE IF NOT EXISTS encounters (
    interaction INTEGER NOT NULL REFERENCES interactions (id), cav TEXT NOT NULL, human TEXT NOT NULL,
    step INTEGER NOT NULL, numbers TEXT NOT NULL, relied INTEGER NOT NULL, yielded INTEGER NOT NULL
)
"""


def keep(connection: sqlite3.Connection, interaction: int, encounters: Sequence[MetDriver]) -> None:
    """Write what was met in one interaction."""
    if encounters:
        connection.execute(_TABLE)
    for met in encounters:
        numbers = json.dumps({name: round(x, 3) for name, x in met.numbers.items()}, sort_keys=True, allow_nan=False)
        row = (interaction, met.cav, met.human, met.step, numbers, int(met.relied), int(met.yielded))
        connection.execute("INSERT INTO encounters VALUES (?, ?, ?, ?, ?, ?, ?)", row)


def forget(connection: sqlite3.Connection, interaction: int) -> None:
    """Take back what was met in one interaction."""
    if _is_there(connection):
        connection.execute("DELETE FROM encounters WHERE interaction = ?", (interaction,))


def met_in(connection: sqlite3.Connection, interactions: Sequence[int]) -> tuple[MetDriver, ...]:
    """Read what was met in some interactions, in their order; files of before hold nothing of it.

    Raises:
        ValueError: If a row cannot be read.
    """
    if not _is_there(connection):
        return ()
    wanted, found = set(interactions), []
    query = "SELECT interaction, cav, human, step, numbers, relied, yielded FROM encounters ORDER BY interaction, rowid"
    for interaction, cav, human, step, text, relied, yielded in connection.execute(query):
        if interaction in wanted:
            numbers = json.loads(text)
            if not isinstance(numbers, dict) or not all(
                isinstance(x, int | float) and isfinite(x) for x in numbers.values()
            ):
                raise ValueError(f"what is known of {human} is {text[:80]}")
            found.append(MetDriver(str(cav), str(human), int(step), numbers, bool(relied), bool(yielded)))
    return tuple(found)


def _is_there(connection: sqlite3.Connection) -> bool:
    query = "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = 'encounters'"
    return bool(connection.execute(query).fetchone()[0])
