"""Streams: vehicles that come from one lane and go one way."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from codriving.datatypes.ordering_problem import Instance

Edge = tuple[int, int]
"""Two streams in conflict, by index, the smaller one first."""


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
        members.setdefault(instance.entrants[name].stream or name, []).append(name)
    names = tuple(members)
    conflicts = {
        (i, j)
        for j in range(len(names))
        for i in range(j)
        if any(is_free(instance, one, other) for one in members[names[i]] for other in members[names[j]])
    }
    return Streams(names, {stream: tuple(found) for stream, found in members.items()}, frozenset(conflicts))


def is_free(instance: Instance, one: str, other: str) -> bool:
    """Whether two vehicles conflict and it is open who goes first."""
    fixed = (one, other) in instance.before or (other, one) in instance.before
    return instance.conflict(one, other) and not fixed
