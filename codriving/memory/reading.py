"""A memory for people: what is in it, and what in it speaks of some words."""

from collections import Counter
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from codriving.datatypes.experience import Interaction
from codriving.errors import MemoryFileError
from codriving.memory.embedder import Embedder
from codriving.memory.embedders import LITELLM, OWN
from codriving.memory.recollection import Kept, Recollection, damaged, load
from codriving.memory.store_file import about, open_file
from codriving.memory.words import Words


@dataclass(frozen=True, slots=True)
class Reading:
    """A file of memories that was read."""

    path: Path
    embedder: str
    dimension: int
    interactions: tuple[Interaction, ...]
    recollection: Recollection

    @property
    def verdicts(self) -> Counter[tuple[str, str]]:
        """How often each action had each effect."""
        counted: Counter[tuple[str, str]] = Counter()
        for entry in self.recollection.kept:
            counted[str(entry.experience.verdict), str(entry.experience.action)] += entry.count
        return counted


def read_memory(path: Path) -> Reading:
    """Read a file, whatever its embedder.

    Raises:
        MemoryFileError: If it is missing, damaged or of another version.
    """
    with closing(open_file(path, write=False)) as connection:
        told = about(connection)
        try:
            name, dimension = told["embedder"], int(told["dimension"])
            rows = connection.execute("SELECT * FROM interactions ORDER BY id").fetchall()
            recollection = load(connection, dimension, name, [row[0] for row in rows])
        except (KeyError, ValueError) as error:
            raise damaged(path, error) from error
    return Reading(path, name, dimension, tuple(Interaction(*row[1:]) for row in rows), recollection)


def own_embedder(reading: Reading) -> Embedder:
    """Return an embedder of the same name that is never asked to embed anything, for copying vectors.

    Raises:
        MemoryFileError: If no such embedder is known.
    """
    for make in OWN.values():
        if make().name == reading.embedder:
            return make()
    if reading.embedder.startswith(f"{LITELLM} "):
        return _Named(reading.embedder, reading.dimension)
    raise MemoryFileError(f"{reading.path} is of an embedder that this version does not know, {reading.embedder}")


class _Named(Words):
    """The name and the length of an embedder whose vectors are all there already."""

    def __init__(self, name: str, dimension: int) -> None:
        super().__init__()
        self.name, self._dimension = name, dimension

    @property
    def dimension(self) -> int:
        """Length of the vectors."""
        return self._dimension


def search(recollection: Recollection, text: str, most: int) -> list[tuple[float, Kept]]:
    """Find the experiences that speak of some words; numbers count by the band that they lie in.

    Returns:
        Similarity and experience, the most similar first, the older first if equal; none that has nothing in common.
    """
    words = Words()
    texts = [f"{k.experience.description.text} {k.experience.action} {k.experience.lesson}" for k in recollection.kept]
    if not texts:
        return []
    scores = (words.embed_texts(texts) @ words.embed_texts([text])[0]).astype(float).round(6)
    ranked = sorted(zip((-scores).tolist(), (k.id for k in recollection.kept), recollection.kept, strict=True))
    return [(-score, kept) for score, _, kept in ranked[:most] if score < 0]
