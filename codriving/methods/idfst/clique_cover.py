"""The fewest layers that there can be: a minimum clique cover of the graph of those who may pass together."""

from collections.abc import Iterable, Mapping

from codriving.methods.idfst.spanning_tree import ConflictGraph, first_layer, idfst

EXACT = 14
"""Up to so many vehicles the cover is exact."""


def minimum_clique_cover(graph: ConflictGraph) -> dict[str, int]:
    """Return layers of which there are as few as possible.

    A clique of those who may pass together is a layer; what is physically fixed keeps its direction. Exact for up to 14
    vehicles, by going through the sets of vehicles that can have passed; beyond that, the better of DSATUR and iDFST.

    Returns:
        Layer of each vehicle, by id; 1 is the first.
    """
    if len(graph.vehicles) <= EXACT:
        return _exact(graph)
    found = dict(idfst(graph).layer), dsatur(graph)
    return min(found, key=lambda layer: max(layer.values()))


def dsatur(graph: ConflictGraph) -> dict[str, int]:
    """Give a layer to whoever has most layers around it shut, again and again (Brelaz's DSATUR with fixed pairs).

    Returns:
        Layer of each vehicle, by id; 1 is the first.
    """
    layer: dict[str, int] = {}
    waiting = list(graph.vehicles)
    while waiting:
        ready = [n for n in waiting if not any((other, n) in graph.fixed for other in waiting)] or waiting

        def urgency(name: str, layer: Mapping[str, int] = layer) -> tuple[int, int]:
            met = [other for other in graph.vehicles if other != name and graph.conflict(other, name)]
            return len({layer[other] for other in met if other in layer}), len(met)

        chosen = max(ready, key=urgency)
        layer[chosen] = first_layer(graph, chosen, layer)
        waiting.remove(chosen)
    return layer


def _exact(graph: ConflictGraph) -> dict[str, int]:
    names = graph.vehicles
    met = [_bits(graph.conflict(a, b) for b in names) for a in names]
    held = [_bits((b, a) in graph.fixed for b in names) for a in names]
    everybody = (1 << len(names)) - 1
    came_from: dict[int, int] = {0: 0}
    reached = [0]
    while everybody not in came_from:
        following: list[int] = []
        for passed in reached:
            waiting = [k for k in range(len(names)) if not passed >> k & 1]
            ready = [k for k in waiting if not held[k] & ~passed] or waiting
            for together in _maximal(ready, met):
                if passed | together not in came_from:
                    came_from[passed | together] = passed
                    following.append(passed | together)
        reached = following
    return _layers(names, came_from, everybody)


def _layers(names: tuple[str, ...], came_from: Mapping[int, int], last: int) -> dict[str, int]:
    """Walk back from everybody to nobody; each step is a layer."""
    steps = []
    while last:
        steps.append(last ^ came_from[last])
        last = came_from[last]
    return {names[k]: d for d, step in enumerate(reversed(steps), 1) for k in range(len(names)) if step >> k & 1}


def _maximal(ready: list[int], met: list[int]) -> list[int]:
    """Return the sets of ready vehicles without a conflict to which nobody can be added, as bits."""
    found = [0]
    for k in ready:
        found += [chosen | 1 << k for chosen in found if not chosen & met[k]]
    return [chosen for chosen in found if all(chosen >> k & 1 or chosen & met[k] for k in ready)]


def _bits(flags: Iterable[bool]) -> int:
    return sum(1 << k for k, flag in enumerate(flags) if flag)
