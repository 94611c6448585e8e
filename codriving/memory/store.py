"""A memory that grows: one SQLite file is the truth, and what is alike is kept once with a count."""

import json
import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager, suppress
from dataclasses import astuple
from pathlib import Path
from typing import Self

import numpy as np

from codriving.datatypes import Description, Experience, Interaction, MetDriver
from codriving.errors import MemoryFileError
from codriving.memory.embedders import Embedder, FeatureEmbedder, Vectors
from codriving.memory.index import Index
from codriving.memory.met import forget, keep, met_in
from codriving.memory.snapshot import Snapshot, load
from codriving.memory.store_file import (
    COLUMNS,
    about,
    check_embedder,
    create,
    damaged,
    from_row,
    open_file,
    to_row,
    unwritable,
    vectors_of,
)

# What tells duplicates where the embedder's own cosines have no known meaning: the numbers of the situations.
_ALIKE = FeatureEmbedder()

NEIGHBOURS = 16  # Nearest experiences among which one with the same action and verdict is looked for


class _TriedError(Exception):
    """Takes back what was written to see whether it can be."""


class MemoryStore:
    """A file of memories that is open for writing; a context manager. Several may have the same file open."""

    def __init__(self, path: Path, embedder: Embedder, duplicates: float) -> None:
        self.path, self.embedder, self.duplicates = path, embedder, duplicates
        self._connection: sqlite3.Connection | None = None
        self._index: Index | None = None
        self._kinds: dict[int, tuple[str, str]] = {}
        self._version = 0
        if path.exists():
            self._open()

    def add(
        self,
        interaction: Interaction,
        experiences: Sequence[Experience],
        vectors: Vectors | None = None,
        encounters: Sequence[MetDriver] = (),
    ) -> int:
        """Add what was learnt in one episode, all of it or nothing; the same episode driven again replaces itself."""
        made = self.embedder.embed([e.description for e in experiences]) if vectors is None else vectors
        if self._connection is None:
            self._open(made.shape[1] if len(made) else None)
        if len(made) and made.shape[1] != self._dimension:
            raise damaged(self.path, ValueError(f"vectors of {self._dimension} numbers expected, got {made.shape[1]}"))
        if not np.isfinite(made).all():
            raise damaged(self.path, ValueError("a new vector holds a number that is not finite"))
        with self._transaction() as connection:
            self._forget(connection, interaction)
            self._catch_up(connection)
            insert = "INSERT INTO interactions (scenario, seed, method, variant, reasoner) VALUES (?, ?, ?, ?, ?)"
            number = int(connection.execute(insert, astuple(interaction)).lastrowid or 0)
            keep(connection, number, encounters)
            alike = made if self.embedder.calibrated else _ALIKE.embed([e.description for e in experiences])
            return sum(self._keep(connection, number, *each) for each in zip(experiences, made, alike, strict=True))

    def check(self) -> None:
        """Refuse a file that cannot be read or written, before anything depends on it; one that is not there is made.

        Raises:
            MemoryFileError: If it, or the folder in which it is, cannot be used.
        """
        if self._connection is None:
            self._open()
        self.snapshot()
        with suppress(_TriedError), self._transaction() as connection:
            # The journal, beside the file, is made by the first change alone.
            connection.execute("INSERT INTO about VALUES ('tried', '')")
            raise _TriedError

    def snapshot(self, before: int | None = None) -> Snapshot:
        """Return what can be recalled now."""
        if self._connection is None:
            return Snapshot((), np.zeros((0, self.embedder.dimension or 1), dtype=np.float32), "", 0)
        try:
            rows = self._connection.execute("SELECT id, seed FROM interactions ORDER BY id").fetchall()
            chosen = [number for number, seed in rows if before is None or seed < before]
            return load(self._connection, self._dimension, self.embedder.name, chosen)
        except (sqlite3.Error, LookupError, ValueError, TypeError, OverflowError) as error:
            raise damaged(self.path, error) from error

    def close(self) -> None:
        """Close the file."""
        if self._connection is not None:
            self._connection.close()
            self._connection = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _open(self, dimension: int | None = None) -> None:
        if not self.path.exists():
            create(self.path, self.embedder.name, dimension or self.embedder.dimension or 1)
        self._connection = open_file(self.path, write=True)
        try:
            self._dimension = check_embedder(self.path, about(self._connection), self.embedder)
        except sqlite3.Error as error:
            self.close()
            raise damaged(self.path, error) from error
        except BaseException:
            self.close()
            raise

    @contextmanager
    def _transaction(self) -> Iterator[sqlite3.Connection]:
        """Change the file in one transaction; a process that is killed meanwhile has done nothing."""
        assert self._connection is not None
        try:
            self._connection.execute("BEGIN IMMEDIATE")
            try:
                yield self._connection
                self._connection.execute("COMMIT")
            except BaseException:
                # The index may know of what never came to be.
                self._index = None
                with suppress(sqlite3.Error):
                    self._connection.execute("ROLLBACK")
                raise
        except ValueError as error:
            raise damaged(self.path, error) from error
        except sqlite3.Error as error:
            raise unwritable(self.path, error) from error

    def _forget(self, connection: sqlite3.Connection, interaction: Interaction) -> None:
        """Take back what an earlier drive of the same episode left, so that it counts once."""
        query = "SELECT id FROM interactions WHERE (scenario, seed, method, variant, reasoner) = (?, ?, ?, ?, ?)"
        for (number,) in connection.execute(query, astuple(interaction)).fetchall():
            connection.execute("DELETE FROM sightings WHERE interaction = ?", (number,))
            forget(connection, number)
            connection.execute("DELETE FROM interactions WHERE id = ?", (number,))
            connection.execute("DELETE FROM experiences WHERE id NOT IN (SELECT experience FROM sightings)")
            self._index = None

    def _catch_up(self, connection: sqlite3.Connection) -> None:
        """Take in what others have changed since."""
        (version,) = connection.execute("PRAGMA data_version").fetchone()
        if self._index is None or version != self._version:
            self._version = version
            self._index, self._kinds = Index(self._compared), {}
        query = "SELECT id, vector, action, verdict, numbers, kinds FROM experiences WHERE id > ? ORDER BY id"
        rows = connection.execute(query, (self._index.ids[-1] if self._index.ids else 0,)).fetchall()
        if self.embedder.calibrated:
            vectors = vectors_of([row[1] for row in rows], self._dimension)
        else:
            vectors = _ALIKE.embed([Description("", "", "", *map(json.loads, row[4:])) for row in rows])
        self._index.add([row[0] for row in rows], vectors)
        self._kinds.update((row[0], (row[2], row[3])) for row in rows)

    @property
    def _compared(self) -> int:
        """Length of the vectors by which experiences are compared."""
        return self._dimension if self.embedder.calibrated else _ALIKE.dimension or 0

    def _keep(
        self, connection: sqlite3.Connection, interaction: int, experience: Experience, vector: Vectors, alike: Vectors
    ) -> bool:
        """Note one experience: as another sighting of one that is like it, or as a new one."""
        assert self._index is not None
        kind = (str(experience.action), str(experience.verdict))
        # Above 1 nothing is a duplicate, and no search is needed.
        (hits,) = self._index.search(alike[None], NEIGHBOURS) if self.duplicates <= 1 else ([],)
        number = next((n for n, similarity in hits if similarity >= self.duplicates and self._kinds[n] == kind), None)
        new = number is None
        if number is None:
            insert = f"INSERT INTO experiences ({', '.join(COLUMNS)}) VALUES ({', '.join('?' * len(COLUMNS))})"
            number = int(connection.execute(insert, to_row(experience, vector)).lastrowid or 0)
            self._index.add([number], alike[None])
            self._kinds[number] = kind
        seen = (number, interaction, experience.step, experience.ego)
        connection.execute("INSERT INTO sightings VALUES (?, ?, ?, ?)", seen)
        return new


def merge(sources: list[Path], target: Path, embedder: Embedder, duplicates: float) -> int:
    """Merge memories into a new file.

    Raises:
        MemoryFileError: If a source cannot be used, the embedders differ, or the target is there or cannot be written.
    """
    if target.exists():
        raise MemoryFileError(f"{target} is there already; name a file that is not, with --out")
    # All are read before anything is written: a damaged one leaves no half of a memory behind.
    everything = [entry for source in sources for entry in read(source, embedder)]
    with MemoryStore(target, embedder, duplicates) as store:
        for interaction, experiences, vectors, met in everything:
            store.add(interaction, experiences, vectors, met)
        return store.snapshot().interactions


def read(
    path: Path, embedder: Embedder
) -> Iterator[tuple[Interaction, list[Experience], Vectors, tuple[MetDriver, ...]]]:
    """Read a memory interaction by interaction, with every sighting."""
    with closing(open_file(path, write=False)) as connection:
        dimension = check_embedder(path, about(connection), embedder)
        query = (
            f"SELECT step, ego, {', '.join(COLUMNS)} FROM sightings JOIN experiences ON id = experience "
            "WHERE interaction = ? ORDER BY step, ego"
        )
        try:
            for number, *row in connection.execute("SELECT * FROM interactions ORDER BY id").fetchall():
                seen = connection.execute(query, (number,)).fetchall()
                experiences = [from_row(tuple(values), step, ego) for step, ego, *values in seen]
                vectors = vectors_of([values[2] for values in seen], dimension)
                yield Interaction(*row), experiences, vectors, met_in(connection, [number])
        except ValueError as error:
            raise damaged(path, error) from error
