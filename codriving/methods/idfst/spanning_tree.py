"""Layers in place of times: the depth-first spanning tree, its improved form, and the fewest layers there can be.

Chen et al. (2022): vehicles of one layer pass together, the depth of the tree is the number of layers. A vehicle far
away blocks a layer as much as one at the line, so the layers are not driven; they say how good an order could be.
"""

from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass
from itertools import combinations

from codriving.datatypes.ordering_problem import Instance, Pair
from codriving.reasoning.ordering.request import Request

ROOT = ""
"""The virtual leader, node 0 of the tree."""


@dataclass(frozen=True, slots=True)
class ConflictGraph:
    """The conflict directed graph without its root."""

    vehicles: tuple[str, ...]
    fixed: Set[Pair]
    free: Set[Pair]

    def conflict(self, one: str, other: str) -> bool:
        """Whether an edge joins two vehicles."""
        return (one, other) in self.free or (one, other) in self.fixed or (other, one) in self.fixed

    def coexisting(self) -> frozenset[Pair]:
        """Return the coexisting undirected graph: pairs that may pass together, in order of arrival."""
        return frozenset(p for p in combinations(self.vehicles, 2) if not self.conflict(*p))


@dataclass(frozen=True, slots=True)
class Tree:
    """A spanning tree."""

    layer: Mapping[str, int]
    parent: Mapping[str, str]

    @property
    def depth(self) -> int:
        """Number of layers."""
        return max(self.layer.values(), default=0)


def conflict_graph(instance: Instance, arrival: Sequence[str]) -> ConflictGraph:
    """Read the graph off an instance."""
    free = {p for p in combinations(arrival, 2) if instance.conflict(*p)}
    free = {(one, other) for one, other in free if not {(one, other), (other, one)} & instance.before}
    return ConflictGraph(tuple(arrival), instance.before, free | {(other, one) for one, other in free})


def dfst(graph: ConflictGraph) -> Tree:
    """Put each vehicle behind the deepest one that it is in conflict with (first in, first out)."""
    layer: dict[str, int] = {}
    parent: dict[str, str] = {}
    for name in graph.vehicles:
        met = [other for other in layer if graph.conflict(other, name)]
        parent[name] = max(met, key=lambda other: layer[other], default=ROOT)
        layer[name] = 1 + layer.get(parent[name], 0)
    return Tree(layer, parent)


def idfst(graph: ConflictGraph) -> Tree:
    """Put each vehicle into the first layer that is free of conflicts and behind whoever has to go before it.

    The layer before that one always holds a vehicle that it is in conflict with, which becomes its parent.
    """
    layer: dict[str, int] = {}
    parent: dict[str, str] = {}
    for name in graph.vehicles:
        depth = first_layer(graph, name, layer)
        met = (other for other in layer if layer[other] == depth - 1 and graph.conflict(other, name))
        layer[name], parent[name] = depth, next(met, ROOT)
    return Tree(layer, parent)


def first_layer(graph: ConflictGraph, name: str, layer: Mapping[str, int]) -> int:
    """Return the smallest layer that a vehicle can join."""
    lowest = max((d for other, d in layer.items() if (other, name) in graph.fixed), default=0)
    used = {d for other, d in layer.items() if (other, name) in graph.free}
    return next(d for d in range(lowest + 1, lowest + len(used) + 2) if d not in used)


def is_feasible(graph: ConflictGraph, layer: Mapping[str, int]) -> bool:
    """Whether no two vehicles of a layer are in conflict, and everybody is behind whoever has to go first."""
    apart = all(layer[i] != layer[j] for i, j in combinations(graph.vehicles, 2) if graph.conflict(i, j))
    return apart and all(layer[i] < layer[j] for i, j in graph.fixed if i in layer and j in layer)


def request_layers(requests: Sequence[Request]) -> list[frozenset[str]]:
    """Sort lane changes into layers in which no two overlap, each into the first one that it can join."""
    pairs = {(r.ego, other) for r in requests for other in r.excludes}
    graph = ConflictGraph(tuple(r.ego for r in requests), frozenset(), pairs | {(b, a) for a, b in pairs})
    layer = idfst(graph).layer
    return [frozenset(n for n, d in layer.items() if d == depth) for depth in sorted(set(layer.values()))]
