"""Controls of learning: a memory in which something has been mixed up, or of which one plain rule is left."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from codriving.datatypes import Action, Memory, Verdict
from codriving.memory.effect import SIDEWAYS
from codriving.memory.embedders import Vectors
from codriving.memory.snapshot import Snapshot, StoredExperience
from codriving.memory.store_file import COLUMNS, vectors_of

Alteration = Literal["none", "verdicts", "situations", "rule", "elsewhere"]

# What becomes of a snapshot, in words for tables.
WORDS: dict[Alteration, str] = {
    "verdicts": "shuffled verdicts",
    "situations": "shuffled situations",
    "rule": "one rule in their place",
    "elsewhere": "of another site",
}

_OF_SITUATION = ("vector", "scene", "conflict", "passing", "numbers", "kinds")
_OF_VERDICT = ("verdict", "effect", "lesson")


def altered(snapshot: Snapshot, how: Alteration) -> Snapshot:
    """Return a snapshot with verdicts or situations dealt out anew among its experiences, or with one rule of it.

    What is dealt out follows from the contents, so that it is the same in each process.
    """
    if how in ("none", "elsewhere") or not (len(snapshot) or snapshot.encounters):
        return snapshot
    if how == "rule":
        return OneRule(snapshot)
    moved = [COLUMNS.index(name) for name in (_OF_VERDICT if how == "verdicts" else _OF_SITUATION)]
    entries = snapshot.experiences
    rng = np.random.default_rng(int(snapshot.digest[:16], 16))
    order = rng.permutation(len(entries)).tolist()
    rows = [list(entry.row) for entry in entries]
    for row, other in zip(rows, order, strict=True):
        for k in moved:
            row[k] = entries[other].row[k]
    dealt = [StoredExperience(e.id, tuple(row), e.count, e.step, e.ego) for e, row in zip(entries, rows, strict=True)]
    vectors = vectors_of([row[0] for row in rows], snapshot.dimension)
    met = snapshot.encounters
    yielded = [met[k].yielded for k in rng.permutation(len(met)).tolist()]
    shuffled = [replace(one, yielded=did) for one, did in zip(met, yielded, strict=True)]
    return Snapshot(dealt, vectors, snapshot.digest, snapshot.interactions, shuffled)


class OneRule(Snapshot):
    """Says at each situation the same: not to do what was a mistake most often. Both lane changes count as one."""

    def __init__(self, snapshot: Snapshot) -> None:
        super().__init__(snapshot.experiences, _vectors(snapshot), snapshot.digest, snapshot.interactions)
        self.avoided = avoided(snapshot.experiences)

    def search(self, queries: Vectors, shots: int, least: float) -> list[tuple[Memory, ...]]:
        """Return the rule for each query."""
        return [self.avoided] * len(queries)


def avoided(entries: Sequence[StoredExperience]) -> tuple[Memory, ...]:
    """Find the action, or the two lane changes, that intensified a conflict most often; nothing if none did."""
    made, first = Counter[Action](), dict[Action, StoredExperience]()
    for entry in entries:
        if entry.experience.verdict is Verdict.INTENSIFIED:
            made[entry.experience.action] += entry.count
            first.setdefault(entry.experience.action, entry)
    kinds = [SIDEWAYS, *((action,) for action in Action if action not in SIDEWAYS)]
    most = max(kinds, key=lambda kind: sum(made[action] for action in kind))
    return tuple(
        Memory(first[a].id, f"{a} is never right.", a, Verdict.INTENSIFIED, 1.0, made[a]) for a in most if made[a]
    )


def _vectors(snapshot: Snapshot) -> Vectors:
    return vectors_of([entry.row[0] for entry in snapshot.experiences], snapshot.dimension)
