"""Streams of vehicles, and every way of giving them levels that makes a difference to the passing order."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

from codriving.datatypes import Instance

Allocation = tuple[int, ...]  # Level of each stream; a lower level goes first

Edge = tuple[int, int]  # Two streams in conflict, by index, the smaller one first


@dataclass(frozen=True, slots=True)
class Streams:
    """The vehicles of an instance, stream by stream."""

    names: tuple[str, ...]
    members: Mapping[str, tuple[str, ...]]
    conflicts: frozenset[Edge]

    def by_vehicle(self, levels: Sequence[int]) -> dict[str, int]:
        """Return the level of each vehicle, by id."""
        return {name: k for stream, k in zip(self.names, levels, strict=True) for name in self.members[stream]}

    def ranked(self, levels: Sequence[int], arrived: Sequence[str]) -> list[str]:
        """Rank the vehicles by the level of their stream, and in a level as they came."""
        return sorted(arrived, key=self.by_vehicle(levels).__getitem__)


def find_streams(instance: Instance, arrived: Sequence[str]) -> Streams:
    """Group the vehicles of an instance."""
    members: dict[str, list[str]] = {}
    for name in arrived:
        members.setdefault(instance.vehicles[name].stream or name, []).append(name)
    names = tuple(members)
    conflicts = {
        (i, j)
        for j in range(len(names))
        for i in range(j)
        if any(is_free(instance, one, other) for one in members[names[i]] for other in members[names[j]])
    }
    return Streams(names, {stream: tuple(found) for stream, found in members.items()}, frozenset(conflicts))


def is_free(instance: Instance, one: str, other: str) -> bool:
    """Whether two vehicles conflict and it is open which goes first."""
    fixed = (one, other) in instance.before or (other, one) in instance.before
    return instance.conflict(one, other) and not fixed


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
        """Yield every allocation that differs in which of two in conflict goes first, beginning with that by index."""
        for after in self._orientations(0, (0,) * self.streams):
            # A stream that comes after more others comes later in at least one way of lining all up.
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


class FewLevels(OwnLevels):
    """Levels end at a highest one, as the source has it: streams in conflict may have to share one."""

    def __init__(self, streams: int, conflicts: Collection[Edge], highest: int) -> None:
        super().__init__(streams, conflicts)
        self.highest = highest

    def of(self, ranks: Sequence[float]) -> Allocation:
        """Return the allocation in which streams go by rank; those beyond the highest level share it."""
        return tuple(min(level, self.highest) for level in super().of(ranks))

    def allocations(self) -> Iterator[Allocation]:
        """Yield every allocation that differs in which of two in conflict goes first, or whether they share a level."""
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


def levels_of(streams: int, conflicts: Collection[Edge], highest: int | None) -> OwnLevels:
    """Return the levels that streams may have."""
    if highest is None or highest >= streams - 1:
        return OwnLevels(streams, conflicts)
    return FewLevels(streams, conflicts, highest)
