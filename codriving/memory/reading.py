"""A memory for people: what is in it, and what in it speaks of some words."""

import sqlite3
from collections import Counter
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from codriving.datatypes import Interaction
from codriving.errors import MemoryFileError
from codriving.memory.embedders import LITELLM, OWN, Embedder, WordEmbedder
from codriving.memory.snapshot import Snapshot, StoredExperience, load
from codriving.memory.store_file import about, damaged, open_file


@dataclass(frozen=True, slots=True)
class Reading:
    """A file of memories that was read."""

    path: Path
    embedder: str
    dimension: int
    interactions: tuple[Interaction, ...]
    snapshot: Snapshot

    @property
    def verdicts(self) -> Counter[tuple[str, str]]:
        """How often each action had each effect."""
        counted: Counter[tuple[str, str]] = Counter()
        for entry in self.snapshot.experiences:
            counted[str(entry.experience.verdict), str(entry.experience.action)] += entry.count
        return counted


def read_memory(path: Path) -> Reading:
    """Read a file, whatever its embedder.

    Raises:
        MemoryFileError: If it is missing, damaged or of another version.
    """
    with closing(open_file(path, write=False)) as connection:
        try:
            said = about(connection)
            name, dimension = said["embedder"], int(said["dimension"])
            rows = connection.execute("SELECT * FROM interactions ORDER BY id").fetchall()
            snapshot = load(connection, dimension, name, [row[0] for row in rows])
        except (sqlite3.Error, LookupError, ValueError, TypeError, OverflowError) as error:
            raise damaged(path, error) from error
    return Reading(path, name, dimension, tuple(Interaction(*row[1:]) for row in rows), snapshot)


def own_embedder(reading: Reading) -> Embedder:
    """Return an embedder of the same name that is never asked to embed anything, for copying vectors.

    Raises:
        MemoryFileError: If no such embedder is known.
    """
    known = [make().name for make in OWN.values()]
    if reading.embedder not in known and not reading.embedder.startswith(f"{LITELLM} "):
        raise MemoryFileError(f"{reading.path} is of an embedder that this version does not know, {reading.embedder}")
    return Embedder(reading.embedder, reading.dimension)


def search(snapshot: Snapshot, text: str, most: int) -> list[tuple[float, StoredExperience]]:
    """Find the experiences that speak of some words; numbers count by the band that they lie in.

    Returns:
        Similarity and experience, the most similar first, the older first if equal; none that has nothing in common.
    """
    words = WordEmbedder()
    known = [k.experience for k in snapshot.experiences]
    texts = [f"{e.description.text} {e.action} {e.lesson}" for e in known]
    if not texts:
        return []
    scores = (words.embed_texts(texts) @ words.embed_texts([text])[0]).astype(float).round(6)
    ranked = sorted(zip((-scores).tolist(), (k.id for k in snapshot.experiences), snapshot.experiences, strict=True))
    return [(-score, kept) for score, _, kept in ranked[:most] if score < 0]
