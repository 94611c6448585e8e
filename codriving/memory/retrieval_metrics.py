"""How well an embedder retrieves: precision at k on experiences that it is not given, against chance."""

from collections.abc import Sequence

from codriving.datatypes import Description
from codriving.memory.embedders import Embedder
from codriving.memory.index import Index

NEAR = 1.0  # Differences of the times to the conflict point that are closer than this are similar [s]


def same_kind(one: Description, other: Description) -> bool:
    """Whether two situations are of the same kind: same relation, same order, similar difference of the times."""
    if any(one.kinds.get(name) != other.kinds.get(name) for name in ("relation", "order")):
        return False
    first, second = one.numbers.get("dttcp"), other.numbers.get("dttcp")
    return first is second if first is None or second is None else abs(first - second) <= NEAR


def precision_at(
    embedder: Embedder, kept: Sequence[Description], held_back: Sequence[Description], ks: Sequence[int]
) -> dict[int, float]:
    """Return the mean share of situations of the same kind among the k most similar ones."""
    vectors = embedder.embed(kept)
    index = Index(vectors.shape[1])
    index.add(range(len(kept)), vectors)
    hits = index.search(embedder.embed(held_back), max(ks))
    found = [[same_kind(query, kept[row]) for row, _ in near] for query, near in zip(held_back, hits, strict=True)]
    return {k: sum(sum(right[:k]) / k for right in found) / len(found) for k in ks}


def chance(kept: Sequence[Description], held_back: Sequence[Description]) -> float:
    """Return the precision of a random draw: the mean share of situations of the same kind."""
    return sum(sum(same_kind(query, d) for d in kept) / len(kept) for query in held_back) / len(held_back)
