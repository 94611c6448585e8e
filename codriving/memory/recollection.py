"""What is recalled from: the experiences of a file, or of its first interactions, as they were when it was opened."""

import hashlib
import sqlite3
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from codriving.datatypes.experience import Experience, Memory
from codriving.errors import MemoryFileError
from codriving.memory.describe import brief
from codriving.memory.embedder import Embedder, Vectors
from codriving.memory.index import Index
from codriving.memory.rows import COLUMNS, from_row, vectors_of
from codriving.memory.store_file import about, open_file


@dataclass(frozen=True, slots=True)
class Kept:
    """An experience of a file.

    Attributes:
        id: Its number.
        experience: The experience.
        count: How often it was made.
    """

    id: int
    experience: Experience
    count: int


class Recollection:
    """Experiences that can be searched; a file that grows meanwhile does not change it.

    Args:
        kept: The experiences, by rising number.
        vectors: Their vectors (n, dimension).
        digest: SHA-256 of the contents.
        interactions: Episodes that they are from.
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
            shots: How many are wanted for each.
            least: Similarity below which an experience says nothing of a situation.

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
        path: The file.
        embedder: Who embeds what is searched for.
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
    """The error for a file whose contents cannot be used.

    Args:
        path: The file.
        error: What is wrong with it.
    """
    return MemoryFileError(f"{path} is damaged ({error}); build it again, or name another one")


def check_embedder(path: Path, told: dict[str, str], embedder: Embedder) -> int:
    """Refuse a file whose vectors are another embedder's.

    Args:
        path: The file.
        told: What it says of itself.
        embedder: Who embeds what is searched for.

    Returns:
        Length of its vectors.

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

    Args:
        connection: The open file.
        dimension: Length of its vectors.
        embedder: Name of its embedder.
        chosen: Numbers of the interactions.

    Raises:
        ValueError: If something in it cannot be read.
        sqlite3.Error: If the file cannot be read.
    """
    marks = set(chosen)
    seen: dict[int, tuple[int, int, str]] = {}
    digest = hashlib.sha256(f"{embedder} {dimension}\n".encode())
    everything = connection.execute("SELECT * FROM interactions ORDER BY id").fetchall()
    for place, row in enumerate(row for row in everything if row[0] in marks):
        _feed(digest, ("interaction", place, *row[1:]))
    query = "SELECT experience, interaction, step, ego FROM sightings ORDER BY experience, interaction, step, ego"
    for experience, interaction, step, ego in connection.execute(query):
        if interaction in marks:
            count, first, who = seen.get(experience, (0, step, ego))
            seen[experience] = (count + 1, first, who)
    kept: list[Kept] = []
    blobs: list[bytes] = []
    for number, *row in connection.execute(f"SELECT id, {', '.join(COLUMNS)} FROM experiences ORDER BY id"):
        if number not in seen:
            continue
        count, step, ego = seen[number]
        _feed(digest, ("experience", len(kept), count, step, ego, *row))
        kept.append(Kept(number, from_row(tuple(row), step, ego), count))
        blobs.append(row[0])
    return Recollection(kept, vectors_of(blobs, dimension), digest.hexdigest(), len(marks))


def _feed(digest: Any, values: Sequence[object]) -> None:  # noqa: ANN401 - hashlib's own class has no public name
    """Add values so that no two different rows give the same bytes."""
    for value in values:
        data = value if isinstance(value, bytes) else str(value).encode()
        digest.update(f"{len(data)}:".encode())
        digest.update(data)
    digest.update(b"\n")
