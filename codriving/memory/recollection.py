"""What is recalled from: the experiences of a file, or of its first interactions, as they were when it was opened."""

import hashlib
import sqlite3
from collections.abc import Sequence
from contextlib import closing
from enum import StrEnum
from pathlib import Path
from typing import Any

from codriving.datatypes.action import Action
from codriving.datatypes.experience import Experience, Memory, Verdict
from codriving.errors import MemoryFileError
from codriving.memory.describe import brief
from codriving.memory.embedder import Embedder, Vectors
from codriving.memory.index import Index
from codriving.memory.rows import COLUMNS, from_row, vectors_of
from codriving.memory.store_file import about, open_file


class Kept:
    """An experience of a file; what is in it is read when it is first asked for."""

    __slots__ = ("_ego", "_experience", "_row", "_step", "count", "id")

    def __init__(self, id: int, row: tuple[Any, ...], count: int, step: int, ego: str) -> None:
        self.id, self.count = id, count
        self._row, self._step, self._ego = row, step, ego
        self._experience: Experience | None = None

    @property
    def experience(self) -> Experience:
        """The experience.

        Raises:
            MemoryFileError: If it cannot be read.
        """
        if self._experience is None:
            try:
                self._experience = from_row(self._row, self._step, self._ego)
            except ValueError as error:
                raise damaged(Path(f"experience {self.id} of the memory"), error) from error
        return self._experience


class Recollection:
    """Experiences that can be searched; a file that grows meanwhile does not change it.

    Args:
        vectors: Their vectors (n, dimension).
    """

    def __init__(self, kept: Sequence[Kept], vectors: Vectors, digest: str, interactions: int) -> None:
        self.kept = tuple(kept)
        self.digest, self.interactions = digest, interactions
        self._by_id = {entry.id: entry for entry in self.kept}
        self._texts: dict[int, str] = {}
        self._index = Index(vectors.shape[1])
        self._index.add([entry.id for entry in self.kept], vectors)

    def __len__(self) -> int:
        """Number of experiences."""
        return len(self.kept)

    def search(self, queries: Vectors, shots: int, least: float) -> list[tuple[Memory, ...]]:
        """Find the most similar experiences.

        Args:
            queries: Vectors of the situations (n, dimension).

        Returns:
            At most so many for each, the most similar first.
        """
        hits = self._index.search(queries, shots)
        return [tuple(self._memory(*hit) for hit in found if hit[1] >= least) for found in hits]

    def _memory(self, number: int, similarity: float) -> Memory:
        entry = self._by_id[number]
        e = entry.experience
        if number not in self._texts:
            self._texts[number] = f"{brief(e.description, e.action)} {e.lesson}"
        return Memory(number, self._texts[number], e.action, e.verdict, similarity, entry.count)


def open_recollection(path: Path, embedder: Embedder, interactions: int | None = None) -> Recollection:
    """Read a file, or what it held after its first interactions.

    Args:
        interactions: How many interactions count; None for all.

    Raises:
        MemoryFileError: If the file is missing, damaged, or of another embedder or version, or has fewer interactions.
    """
    with closing(open_file(path, write=False)) as connection:
        dimension = check_embedder(path, about(connection), embedder)
        try:
            chosen = _chosen(connection, interactions)
            if interactions is not None and len(chosen) < interactions:
                raise MemoryFileError(
                    f"memory.interactions is {interactions}, but {path} is of {len(chosen)} interactions; "
                    "build a larger one"
                )
            return load(connection, dimension, embedder.name, chosen)
        except (sqlite3.Error, ValueError) as error:
            raise damaged(path, error) from error


def damaged(path: Path, error: Exception) -> MemoryFileError:
    """The error for a file whose contents cannot be used."""
    return MemoryFileError(f"{path} is damaged ({error}); build it again, or name another one")


def check_embedder(path: Path, told: dict[str, str], embedder: Embedder) -> int:
    """Refuse a file whose vectors are another embedder's.

    Raises:
        MemoryFileError: If the embedder or the length differ.
    """
    name, dimension = told.get("embedder", "none"), told.get("dimension", "")
    if name != embedder.name:
        raise MemoryFileError(
            f"{path} was made with the embedder {name}, and {embedder.name} is asked for; set memory.embedder to "
            "match, or build it again"
        )
    if not dimension.isdigit() or (embedder.dimension is not None and int(dimension) != embedder.dimension):
        raise MemoryFileError(
            f"{path} holds vectors of {dimension or 'unknown'} numbers, and {embedder.name} makes "
            f"{embedder.dimension}; build it again"
        )
    return int(dimension)


def _chosen(connection: sqlite3.Connection, interactions: int | None) -> list[int]:
    limit = -1 if interactions is None else interactions
    return [n for (n,) in connection.execute("SELECT id FROM interactions ORDER BY id LIMIT ?", (limit,))]


def load(connection: sqlite3.Connection, dimension: int, embedder: str, chosen: Sequence[int]) -> Recollection:
    """Read what was seen in some interactions.

    Raises:
        ValueError: If something in it cannot be read.
        sqlite3.Error: If the file cannot be read.
    """
    digest = hashlib.sha256(f"{embedder} {dimension}\n".encode())
    wanted = set(chosen)
    for row in connection.execute("SELECT * FROM interactions ORDER BY id"):
        if row[0] in wanted:
            digest.update(repr(row[1:]).encode())
    seen = _sightings(connection, chosen)
    kept: list[Kept] = []
    blobs: list[bytes] = []
    _refuse_damaged(connection)
    for number, vector, *rest in connection.execute(f"SELECT id, {', '.join(COLUMNS)} FROM experiences ORDER BY id"):
        found = seen.get(number)
        if found is None:
            continue
        digest.update(repr((*found, *rest)).encode())
        digest.update(vector)
        kept.append(Kept(number, (vector, *rest), *found))
        blobs.append(vector)
    return Recollection(kept, vectors_of(blobs, dimension), digest.hexdigest(), len(chosen))


def _sightings(connection: sqlite3.Connection, chosen: Sequence[int]) -> dict[int, tuple[int, int, str]]:
    """How often each experience was made in some interactions, and at which step and by whom first."""
    connection.execute("CREATE TEMP TABLE IF NOT EXISTS chosen (id INTEGER PRIMARY KEY)")
    connection.execute("DELETE FROM chosen")
    connection.execute("BEGIN")
    connection.executemany("INSERT INTO chosen VALUES (?)", ((number,) for number in chosen))
    connection.execute("COMMIT")
    # Of rows that share an experience, step and ego are those of the row with the smallest key.
    rows = connection.execute(
        "SELECT experience, count(*), step, ego, min(printf('%012d %012d %s', interaction, step, ego)) FROM sightings "
        "WHERE interaction IN (SELECT id FROM chosen) GROUP BY experience"
    )
    return {experience: (count, step, ego) for experience, count, step, ego, _ in rows}


def _refuse_damaged(connection: sqlite3.Connection) -> None:
    """Find in one go what could not be read later."""
    words = {name: ", ".join(f"'{member.value}'" for member in kind) for name, kind in _ENUMS.items()}
    (broken,) = connection.execute(
        "SELECT count(*) FROM experiences WHERE NOT (json_valid(numbers) AND json_valid(kinds) AND json_valid(effect)) "
        f"OR action NOT IN ({words['action']}) OR verdict NOT IN ({words['verdict']})"
    ).fetchone()
    if broken:
        raise ValueError(f"{broken} experiences cannot be read")


_ENUMS: dict[str, type[StrEnum]] = {"action": Action, "verdict": Verdict}
