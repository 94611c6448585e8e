"""A better order by local search: it keeps what it must, costs no vehicle anything, and stays as it is."""

from itertools import permutations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from codriving.datatypes.order import ApproachingVehicle, Instance, PassingOrder, Precedence
from codriving.reasoning.ordering.coordinator import cost, improve
from codriving.reasoning.ordering.schedule import start_time

SAVES = 0.3
SWAP = 1.0

NAMES = ("a", "b", "c", "d", "e")
TIMES = st.floats(-2.0, 20.0).map(lambda t: round(t, 2))
WINDOW = st.tuples(TIMES, st.floats(0.1, 8.0)).map(lambda w: (w[0], w[0] + w[1]))
Separation = dict[tuple[str, str], float]


def slot(name: str, eta: float, *windows: tuple[float, float]) -> ApproachingVehicle:
    return ApproachingVehicle(name, 100.0, eta, windows=list(windows))


@st.composite
def problems(draw: st.DrawFn) -> tuple[dict[str, ApproachingVehicle], Separation, set[tuple[str, str]]]:
    """Some vehicles, what must lie between them, and pairs whose order is fixed, without a circle."""
    names = NAMES[: draw(st.integers(2, len(NAMES)))]
    slots = {name: slot(name, draw(TIMES), *draw(st.lists(WINDOW, max_size=2))) for name in names}
    separation: Separation = {}
    for pair in permutations(names, 2):
        if draw(st.booleans()):
            separation[pair] = draw(st.floats(0.2, 4.0))
    line = draw(st.permutations(names))
    fixed = {(a, b) for i, a in enumerate(line) for b in line[i + 1 :] if draw(st.integers(0, 3)) == 0}
    return slots, separation, fixed


def schedule(order: tuple[str, ...], slots: dict[str, ApproachingVehicle], separation: Separation) -> dict[str, float]:
    times: dict[str, float] = {}
    for name in order:
        times[name] = start_time(Instance(0.0, slots, separation, set()), name, times)
    return times


def first(
    slots: dict[str, ApproachingVehicle], separation: Separation, fixed: set[tuple[str, str]]
) -> dict[str, float]:
    """A schedule to begin with: the vehicle that may go and can go first."""
    times: dict[str, float] = {}
    while len(times) < len(slots):
        ready = [n for n in slots if n not in times and all(a in times for a, b in fixed if b == n)]
        instance = Instance(0.0, slots, separation, set())
        time, name = min((start_time(instance, n, times), n) for n in ready)
        times[name] = time
    return times


@settings(max_examples=150, deadline=None)
@given(problems(), st.permutations(NAMES) | st.none())
def test_it_keeps_fixed_pairs_and_never_costs_more(
    problem: tuple[dict[str, ApproachingVehicle], Separation, set[tuple[str, str]]], agreed: list[str] | None
) -> None:
    slots, separation, fixed = problem
    line = [name for name in agreed or () if name in slots]
    pairs = tuple(Precedence(a, b, "agreed") for i, a in enumerate(line) for b in line[i + 1 :])
    previous = PassingOrder(tuple(line), pairs) if agreed else None
    begin = first(slots, separation, fixed)
    times = improve(begin, Instance(0.0, slots, separation, fixed), previous)
    assert set(times) == set(slots)
    rank = {name: k for k, name in enumerate(times)}
    assert all(rank[a] < rank[b] for a, b in fixed), "the vehicle that cannot be overtaken stays ahead"
    assert times == schedule(tuple(times), slots, separation), "these are the times of that order"
    in_turn = schedule(tuple(sorted(begin, key=lambda name: (begin[name], name))), slots, separation)
    if all(list(in_turn).index(a) < list(in_turn).index(b) for a, b in fixed):
        assert (
            cost(times, Instance(0.0, slots, {}, set()), previous)
            <= cost(in_turn, Instance(0.0, slots, {}, set()), previous) + 1e-9
        )
    else:
        assert times == begin
    # No vehicle passes before it can be there, or while a human driver does.
    for name, time in times.items():
        assert time >= slots[name].eta
        assert all(not begin < time < end for begin, end in slots[name].windows)


def two(lead: float, saving: float) -> tuple[dict[str, ApproachingVehicle], Separation]:
    """Two vehicles, of which a comes earlier; b before a would save all together some time."""
    return {"a": slot("a", 5.0), "b": slot("b", 5.0 + lead)}, {("a", "b"): 2.0 + lead + saving, ("b", "a"): 2.0 - lead}


@pytest.mark.parametrize(("saving", "order"), [(SAVES - 0.05, ["a", "b"]), (SAVES + 0.05, ["b", "a"])])
def test_who_comes_later_goes_first_only_if_that_saves_enough(saving: float, order: list[str]) -> None:
    slots, separation = two(0.5, saving)
    begin = schedule(("a", "b"), slots, separation)
    assert sum(begin.values()) == pytest.approx(sum(schedule(("b", "a"), slots, separation).values()) + saving)
    assert list(improve(begin, Instance(0.0, slots, separation, set()), None)) == order


@pytest.mark.parametrize(("saving", "order"), [(SAVES + SWAP - 0.05, ["a", "b"]), (SAVES + SWAP + 0.05, ["b", "a"])])
def test_what_was_agreed_is_turned_round_only_for_more(saving: float, order: list[str]) -> None:
    slots, separation = two(0.5, saving)
    agreed = PassingOrder(("a", "b"), (Precedence("a", "b", "agreed"),))
    begin = schedule(("a", "b"), slots, separation)
    assert list(improve(begin, Instance(0.0, slots, separation, set()), agreed)) == order
    assert list(improve(begin, Instance(0.0, slots, separation, set()), None)) == ["b", "a"]


def test_a_fixed_pair_is_not_turned_round_whatever_it_saves() -> None:
    slots, separation = two(0.5, 9.0)
    begin = schedule(("a", "b"), slots, separation)
    assert list(improve(begin, Instance(0.0, slots, separation, set()), None)) == ["b", "a"]
    assert improve(begin, Instance(0.0, slots, separation, {("a", "b")}), None) == begin


def test_one_who_holds_up_many_lets_them_pass() -> None:
    slots = {"slow": slot("slow", 1.0)} | {name: slot(name, 1.5) for name in "bcd"}
    separation = {("slow", name): 6.0 for name in "bcd"} | {(name, "slow"): 0.5 for name in "bcd"}
    begin = schedule(("slow", "b", "c", "d"), slots, separation)
    times = improve(begin, Instance(0.0, slots, separation, set()), None)
    assert list(times)[-1] == "slow"
    assert sum(times.values()) == pytest.approx(4.5 + 2.0)


def test_costs_are_delays_and_broken_agreements() -> None:
    slots = {"a": slot("a", 3.0), "b": slot("b", -1.0)}
    agreed = PassingOrder(("a", "b"), (Precedence("a", "b", "agreed"), Precedence("x", "a", "gone")))
    assert cost({"b": 0.0, "a": 5.0}, Instance(0.0, slots, {}, set()), None) == pytest.approx(2.0)
    assert cost({"b": 0.0, "a": 5.0}, Instance(0.0, slots, {}, set()), agreed) == pytest.approx(2.0 + SWAP)
    assert cost({"a": 5.0, "b": 0.0}, Instance(0.0, slots, {}, set()), agreed) == pytest.approx(2.0)
