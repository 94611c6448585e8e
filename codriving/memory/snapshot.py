"""What is recalled from: the experiences of a file, or of its first interactions, as they were when it was opened."""

import dataclasses
import hashlib
import sqlite3
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from codriving.datatypes import Action, Effect, Experience, Memory, MetDriver, Verdict
from codriving.errors import MemoryFileError
from codriving.memory.describe import brief
from codriving.memory.embedders import Embedder, FeatureEmbedder, Vectors
from codriving.memory.index import Index
from codriving.memory.met import met_in
from codriving.memory.store_file import COLUMNS, about, check_embedder, damaged, from_row, open_file, vectors_of

SAMPLE = 300  # Experiences, the oldest, by which similarities of embedders are compared


@dataclass
class StoredExperience:
    """An experience of a file, read from its row when it is first needed."""

    id: int
    row: tuple[Any, ...]  # The values of ``COLUMNS``
    count: int  # How often it was made
    step: int  # Decision step at which it was first made
    ego: str  # The CAV that first made it

    @cached_property
    def experience(self) -> Experience:
        """The experience.

        Raises:
            MemoryFileError: If it cannot be read.
        """
        try:
            return from_row(self.row, self.step, self.ego)
        except ValueError as error:
            raise damaged(Path(f"experience {self.id} of the memory"), error) from error

    @cached_property
    def text(self) -> str:
        """The experience in one line, as a decider is told of it."""
        e = self.experience
        return f"{brief(e.description, e.action)} {e.lesson}"


class Snapshot:
    """Experiences that can be searched; a file that grows meanwhile does not change it."""

    def __init__(
        self,
        experiences: Sequence[StoredExperience],
        vectors: Vectors,
        digest: str,
        interactions: int,
        encounters: Sequence[MetDriver] = (),
    ) -> None:
        self.experiences, self.encounters = tuple(experiences), tuple(encounters)
        self.digest, self.interactions = digest, interactions
        self._by_id = {entry.id: entry for entry in self.experiences}
        self.dimension = vectors.shape[1]
        self._index = Index(self.dimension)
        self._index.add(list(self._by_id), vectors)
        self._sample = vectors[:SAMPLE]
        self._least: dict[float, float] = {}

    def __len__(self) -> int:
        """Number of experiences."""
        return len(self.experiences)

    def search(self, queries: Vectors, shots: int, least: float) -> list[tuple[Memory, ...]]:
        """Find the most similar experiences."""
        hits = self._index.search(queries, shots)
        return [tuple(self._memory(*hit) for hit in found if hit[1] >= least) for found in hits]

    def equivalent(self, least: float) -> float:
        """Translate a similarity by ``features`` into one by the vectors of this file.

        It is the cosine that as many pairs of experiences reach, so that as large a share of them counts as alike.
        """
        if least not in self._least:
            told = [entry.experience.description for entry in self.experiences[:SAMPLE]]
            above, own = (_pairs(vectors) for vectors in (FeatureEmbedder().embed(told), self._sample))
            alike = int((above >= least).sum())
            # Between the last that reaches it and the first that does not; without pairs it is what was given.
            edges = [*own[alike - 1 : alike], *own[alike : alike + 1]] if alike else [*own[:1], *[1.0] * bool(len(own))]
            self._least[least] = sum(map(float, edges)) / len(edges) if edges else least
        return self._least[least]

    def _memory(self, number: int, similarity: float) -> Memory:
        entry = self._by_id[number]
        return Memory(number, entry.text, entry.experience.action, entry.experience.verdict, similarity, entry.count)


def _pairs(vectors: Vectors) -> Vectors:
    """The cosines of all pairs, the largest first."""
    every: Vectors = (vectors @ vectors.T)[np.triu_indices(len(vectors), 1)]
    return np.sort(every)[::-1]


def open_snapshot(path: Path, embedder: Embedder, interactions: int | None = None) -> Snapshot:
    """Read a file, or what it held after its first interactions."""
    with closing(open_file(path, write=False)) as connection:
        try:
            dimension = check_embedder(path, about(connection), embedder)
            limit = -1 if interactions is None else interactions
            chosen = [n for (n,) in connection.execute("SELECT id FROM interactions ORDER BY id LIMIT ?", (limit,))]
            if interactions is not None and len(chosen) < interactions:
                raise MemoryFileError(
                    f"memory.interactions is {interactions}, but {path} is of {len(chosen)} interactions; "
                    "build a larger one"
                )
            return load(connection, dimension, embedder.name, chosen)
        except (sqlite3.Error, LookupError, ValueError, TypeError, OverflowError) as error:
            raise damaged(path, error) from error


def load(connection: sqlite3.Connection, dimension: int, embedder: str, chosen: Sequence[int]) -> Snapshot:
    """Read what was experienced in some interactions."""
    _refuse_damaged(connection)
    digest = hashlib.sha256(f"{embedder} {dimension}\n".encode())
    wanted = set(chosen)
    for row in connection.execute("SELECT * FROM interactions ORDER BY id"):
        if row[0] in wanted:
            digest.update(repr(row[1:]).encode())
    seen = _sightings(connection, chosen)
    found: list[StoredExperience] = []
    blobs: list[bytes] = []
    for number, vector, *rest in connection.execute(f"SELECT id, {', '.join(COLUMNS)} FROM experiences ORDER BY id"):
        if number not in seen:
            continue
        digest.update(repr((*seen[number], *rest)).encode())
        digest.update(vector)
        found.append(StoredExperience(number, (vector, *rest), *seen[number]))
        blobs.append(vector)
    encounters = met_in(connection, chosen)
    for met in encounters:
        digest.update(repr(met).encode())
    return Snapshot(found, vectors_of(blobs, dimension), digest.hexdigest(), len(chosen), encounters)


def _sightings(connection: sqlite3.Connection, chosen: Sequence[int]) -> dict[int, tuple[int, int, str]]:
    """How often each experience was made in some interactions, and at which step and by which CAV first."""
    connection.execute("CREATE TEMP TABLE IF NOT EXISTS chosen (id INTEGER PRIMARY KEY)")
    connection.execute("DELETE FROM chosen")
    connection.execute("BEGIN")
    connection.executemany("INSERT INTO chosen VALUES (?)", ((number,) for number in chosen))
    connection.execute("COMMIT")
    # Of rows of the same experience, step and ego are those of the row with the smallest key.
    rows = connection.execute(
        "SELECT experience, count(*), step, ego, min(printf('%012d %012d %s', interaction, step, ego)) FROM sightings "
        "WHERE interaction IN (SELECT id FROM chosen) GROUP BY experience"
    )
    return {experience: (count, step, ego) for experience, count, step, ego, _ in rows}


_NAMED = ("mine", "its", "my_ttcp", "its_ttcp", "dttcp")  # Numbers that belong to a conflict


def _refuse_damaged(connection: sqlite3.Connection) -> None:
    """Find in one go what could not be read later."""
    _refuse(connection, "interactions", _typed("seed", "scenario", "method", "variant", "reasoner"))
    known = "experience IN (SELECT id FROM experiences) AND interaction IN (SELECT id FROM interactions)"
    _refuse(connection, "sightings", f"{_typed('step', 'ego')} AND {known}")
    actions, verdicts = (", ".join(f"'{member.value}'" for member in kind) for kind in (Action, Verdict))
    # The texts are JSON, and as they are written, without blanks, what is in them shows without reading them.
    rest = "effect"
    for field in dataclasses.fields(Effect):
        rest = f"replace({rest}, '\"{field.name}\":', ':')"
    told = " AND ".join(_has("numbers", name) for name in _NAMED)
    order = " OR ".join(f'instr(kinds, \'"order":"{order}"\')' for order in ("first", "second", "none"))
    _refuse(
        connection,
        "experiences",
        f"{_typed('id', *COLUMNS[1:])} AND typeof(vector) = 'blob' AND action IN ({actions}) "
        f"AND verdict IN ({verdicts}) AND json_valid(numbers) AND json_valid(kinds) AND json_valid(effect) "
        "AND numbers GLOB '{*}' AND numbers NOT GLOB '*:[^-0-9]*' AND kinds GLOB '{*}' AND kinds NOT GLOB '*:[^\"]*' "
        f"AND effect GLOB '{{*}}' AND {rest} NOT GLOB '*[^-0-9.e+truefalsn:,{{}}]*' "
        f"AND {_has('numbers', 'speed')} AND {_has('kinds', 'relation')} "
        'AND iif(instr(kinds, \'"relation":"none"\'), '
        f"NOT {_has('numbers', 'lead_gap')} OR {_has('numbers', 'lead_speed')}, "
        f"{_has('kinds', 'driver')} AND ({order}) AND {told})",
    )


def _typed(number: str, *texts: str) -> str:
    return " AND ".join([f"typeof({number}) = 'integer'", *(f"typeof({name}) = 'text'" for name in texts)])


def _has(column: str, key: str) -> str:
    return f"instr({column}, '\"{key}\":')"


def _refuse(connection: sqlite3.Connection, table: str, holds: str) -> None:
    (broken,) = connection.execute(f"SELECT count(*) FROM {table} WHERE NOT coalesce({holds}, 0)").fetchone()
    if broken:
        raise ValueError(f"{broken} {table} cannot be read")
