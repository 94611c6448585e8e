"""Two memories into one: the interactions of the first, then those of the second, what is alike kept once."""

from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

from codriving.datatypes.experience import Experience, Interaction
from codriving.errors import MemoryFileError
from codriving.memory.embedder import Embedder, Vectors
from codriving.memory.recollection import check_embedder, damaged
from codriving.memory.rows import COLUMNS, from_row, vectors_of
from codriving.memory.store import MemoryStore
from codriving.memory.store_file import about, open_file


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
        for interaction, experiences, vectors in everything:
            store.add(interaction, experiences, vectors)
        return store.recollection().interactions


def read(path: Path, embedder: Embedder) -> Iterator[tuple[Interaction, list[Experience], Vectors]]:
    """Read a memory interaction by interaction, with every sighting.

    Yields:
        An interaction, what was learnt in it, and the vectors of that (n, dimension).

    Raises:
        MemoryFileError: If the file cannot be used.
    """
    with closing(open_file(path, write=False)) as connection:
        dimension = check_embedder(path, about(connection), embedder)
        try:
            for number, *row in connection.execute("SELECT * FROM interactions ORDER BY id").fetchall():
                seen = connection.execute(
                    f"SELECT step, ego, {', '.join(COLUMNS)} FROM sightings JOIN experiences ON id = experience "
                    "WHERE interaction = ? ORDER BY step, ego",
                    (number,),
                ).fetchall()
                experiences = [from_row(tuple(values), step, ego) for step, ego, *values in seen]
                yield Interaction(*row), experiences, vectors_of([values[2] for values in seen], dimension)
        except ValueError as error:
            raise damaged(path, error) from error
