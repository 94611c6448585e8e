"""Every way of giving streams levels that makes a difference: who plans against whose motion."""

from collections.abc import Collection, Iterator, Sequence
from itertools import product

from codriving.methods.coop_game.streams import Edge

Allocation = tuple[int, ...]
"""Level of each stream; a lower level goes first."""


def layered(ranks: Sequence[float], conflicts: Collection[Edge]) -> Allocation:
    """Return the least levels in which streams in conflict go one after another.

    Streams without a conflict between them share a level wherever they can.
    """
    levels = [0] * len(ranks)
    turn = sorted(range(len(ranks)), key=lambda i: (ranks[i], i))
    place = {stream: k for k, stream in enumerate(turn)}
    for stream in turn:
        others = [i + j - stream for i, j in conflicts if stream in (i, j)]
        levels[stream] = max((levels[k] + 1 for k in others if place[k] < place[stream]), default=0)
    return tuple(levels)


class OwnLevels:
    """Streams in conflict never share a level: as many levels as that needs."""

    def __init__(self, streams: int, conflicts: Collection[Edge]) -> None:
        self.streams, self.conflicts = streams, tuple(sorted(conflicts))

    def of(self, ranks: Sequence[float]) -> Allocation:
        """Return the allocation in which streams go by rank."""
        return layered(ranks, self.conflicts)

    def allocations(self) -> Iterator[Allocation]:
        """Yield every allocation that differs in who goes first of two in conflict, beginning with that by index."""
        for after in self._orientations(0, (0,) * self.streams):
            # Whoever comes after more others comes later in at least one way of lining all up.
            yield layered([after[i].bit_count() for i in range(self.streams)], self.conflicts)

    def _orientations(self, k: int, after: tuple[int, ...]) -> Iterator[tuple[int, ...]]:
        """Let the streams of one conflict after another go in either order, as long as there is no circle."""
        if k == len(self.conflicts):
            yield after
            return
        i, j = self.conflicts[k]
        for first, second in ((i, j), (j, i)):
            if not after[first] >> second & 1:
                new = after[first] | 1 << first
                grown = tuple(
                    bits | new if stream == second or bits >> second & 1 else bits for stream, bits in enumerate(after)
                )
                yield from self._orientations(k + 1, grown)

    def moves(self, allocation: Allocation, stream: int) -> Iterator[Allocation]:
        """Yield what becomes of an allocation if one stream goes before, between or after the levels of the others."""
        for place in range(max(allocation) + 2):
            ranks = [float(k) for k in allocation]
            ranks[stream] = place - 0.5
            yield layered(ranks, self.conflicts)


class FewLevels:
    """Levels end at a highest one, as the source has it: streams in conflict may have to share one."""

    def __init__(self, streams: int, conflicts: Collection[Edge], highest: int) -> None:
        self.streams, self.conflicts, self.highest = streams, tuple(sorted(conflicts)), highest

    def of(self, ranks: Sequence[float]) -> Allocation:
        """Return the allocation in which streams go by rank; those beyond the highest level share it."""
        return tuple(min(level, self.highest) for level in layered(ranks, self.conflicts))

    def allocations(self) -> Iterator[Allocation]:
        """Yield every allocation that differs in who goes first of two in conflict, or whether they share a level."""
        meets = {stream for edge in self.conflicts for stream in edge}
        ranges = [range(self.highest + 1) if i in meets else range(1) for i in range(self.streams)]
        seen = set()
        for levels in product(*ranges):
            relation = tuple((levels[i] > levels[j]) - (levels[i] < levels[j]) for i, j in self.conflicts)
            if relation not in seen:
                seen.add(relation)
                yield levels

    def moves(self, allocation: Allocation, stream: int) -> Iterator[Allocation]:
        """Yield what becomes of an allocation if one stream takes another level."""
        for level in range(self.highest + 1):
            yield (*allocation[:stream], level, *allocation[stream + 1 :])


Levels = OwnLevels | FewLevels


def levels_of(streams: int, conflicts: Collection[Edge], highest: int | None) -> Levels:
    """Return the levels that streams may have.

    Args:
        highest: The highest level; None for as many as there are streams.
    """
    if highest is None or highest >= streams - 1:
        return OwnLevels(streams, conflicts)
    return FewLevels(streams, conflicts, highest)
