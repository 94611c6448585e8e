"""Trees in layers: iDFST dominates DFST vehicle by vehicle, and nothing has fewer layers than the clique cover."""

from itertools import permutations

import pytest
from instances import crossroads, instance

from codriving.datatypes.ordering_problem import Instance
from codriving.methods.idfst.clique_cover import dsatur, minimum_clique_cover
from codriving.methods.idfst.spanning_tree import (
    ROOT,
    ConflictGraph,
    conflict_graph,
    dfst,
    first_layer,
    idfst,
    is_feasible,
)


def graph_of(problem: Instance) -> ConflictGraph:
    return conflict_graph(problem, sorted(problem.entrants, key=lambda n: (problem.entrants[n].eta, n)))


def graph(names: str, free: str, fixed: str = "") -> ConflictGraph:
    """Return a graph by hand; edges are pairs of letters."""
    pairs = {(pair[0], pair[1]) for pair in free.split()}
    bound = frozenset((pair[0], pair[1]) for pair in fixed.split())
    return ConflictGraph(tuple(names), bound, pairs | {(b, a) for a, b in pairs})


def test_idfst_puts_nobody_deeper_than_dfst() -> None:
    total = {"idfst": 0, "dfst": 0}
    for seed in range(10_000, 12_000):
        made = graph_of(crossroads(seed, 4 + seed % 21))
        improved, plain = idfst(made), dfst(made)
        assert all(improved.layer[name] <= plain.layer[name] for name in made.vehicles), seed
        assert is_feasible(made, improved.layer)
        assert is_feasible(made, plain.layer)
        total["idfst"] += improved.depth
        total["dfst"] += plain.depth
    assert total["idfst"] < total["dfst"]


def test_no_cover_has_more_layers_than_idfst_or_dfst() -> None:
    fewer = 0
    for seed in range(10_000, 10_150):
        made = graph_of(crossroads(seed, 3 + seed % 8))
        cover = minimum_clique_cover(made)
        assert is_feasible(made, cover)
        assert max(cover.values()) <= idfst(made).depth <= dfst(made).depth
        fewer += max(cover.values()) < idfst(made).depth
    assert fewer > 0


@pytest.mark.parametrize("seed", range(10_000, 10_012))
def test_cover_is_the_best_of_all_orders_of_insertion(seed: int) -> None:
    made = graph_of(crossroads(seed, 6))
    found = len(made.vehicles)
    for order in permutations(made.vehicles):
        if all(order.index(i) < order.index(j) for i, j in made.fixed):
            found = min(found, idfst(ConflictGraph(order, made.fixed, made.free)).depth)
    assert max(minimum_clique_cover(made).values()) == found


@pytest.mark.parametrize("n", [15, 20, 24])
def test_beyond_fourteen_the_cover_is_feasible_and_not_worse_than_idfst(n: int) -> None:
    for seed in range(10_000, 10_010):
        made = graph_of(crossroads(seed, n))
        assert is_feasible(made, dsatur(made))
        assert max(minimum_clique_cover(made).values()) <= idfst(made).depth


def test_a_vehicle_joins_the_first_layer_that_is_free() -> None:
    # c meets b alone: behind b for DFST, beside a for iDFST.
    made = graph("abc", "ab bc")
    assert dfst(made).layer == {"a": 1, "b": 2, "c": 3}
    assert idfst(made).layer == {"a": 1, "b": 2, "c": 1}


def test_the_parent_is_a_neighbour_one_layer_up() -> None:
    for seed in range(10_000, 10_050):
        made = graph_of(crossroads(seed, 12))
        for tree in (idfst(made), dfst(made)):
            for name, parent in tree.parent.items():
                assert (parent == ROOT) == (tree.layer[name] == 1)
                assert parent == ROOT or made.conflict(parent, name)
                assert tree.layer[name] == 1 + tree.layer.get(parent, 0)


def test_fixed_pairs_are_edges_in_one_direction() -> None:
    problem = instance({"a": 1.0, "b": 2.0, "c": 3.0}, {("a", "b"): 1.0, ("c", "b"): 1.0}, [("a", "b")])
    made = conflict_graph(problem, ["a", "b", "c"])
    assert made.fixed == {("a", "b")}
    assert made.free == {("b", "c"), ("c", "b")}
    assert made.coexisting() == {("a", "c")}


def test_layers_against_a_fixed_pair_are_not_feasible() -> None:
    made = graph("ab", "", "ab")
    assert not is_feasible(made, {"a": 2, "b": 1})
    assert not is_feasible(made, {"a": 1, "b": 1})
    assert is_feasible(made, {"a": 1, "b": 2})
    assert first_layer(made, "b", {"a": 4}) == 5


def test_far_vehicle_takes_a_layer_and_that_is_why_layers_are_not_driven() -> None:
    # Whoever comes in 30 s is layer 1 if it holds the first number; n waits in layer 2 though it arrives in 2 s.
    made = conflict_graph(instance({"far": 30.0, "n": 2.0}, {("far", "n"): 1.0, ("n", "far"): 1.0}), ["far", "n"])
    assert idfst(made).layer == {"far": 1, "n": 2}


def test_nobody_needs_no_layer() -> None:
    empty = graph("", "")
    assert (idfst(empty).depth, dfst(empty).depth, minimum_clique_cover(empty)) == (0, 0, {})
