"""The random passing order: drawn once a vehicle, kept, and never against what is physically fixed."""

from collections import Counter
from itertools import permutations

from instances import NoPlanner, both, crossroads, instance, is_valid

from codriving.datatypes.world import Action
from codriving.reasoning.ordering.protocol import Request
from codriving.reasoning.ordering.random_order import RandomOrder

THREE = both("a", "b", 2.0) | both("a", "c", 2.0) | both("b", "c", 2.0)


def drawn(seed: int) -> RandomOrder:
    """Return the rule at the beginning of an episode."""
    rule = RandomOrder()
    rule.reset(seed)
    return rule


def test_all_orders_of_three_come_about_as_often() -> None:
    problem = instance({"a": 3.0, "b": 3.0, "c": 3.0}, THREE)
    found = Counter(drawn(seed).order(problem, NoPlanner()).sequence for seed in range(600))
    assert set(found) == set(permutations("abc"))
    assert min(found.values()) >= 70
    assert max(found.values()) <= 130


def test_order_is_kept_over_the_episode_and_does_not_depend_on_who_else_is_there() -> None:
    for seed in range(30):
        rule = drawn(seed)
        first = rule.order(instance({"a": 3.0, "b": 4.0, "c": 5.0}, THREE), NoPlanner()).sequence
        later = rule.order(instance({"c": 0.5, "b": 9.0, "a": 1.0}, THREE, time=4.0), NoPlanner()).sequence
        alone = drawn(seed).order(instance({"c": 5.0, "a": 3.0}, both("a", "c", 2.0)), NoPlanner()).sequence
        assert later == first
        assert alone == tuple(name for name in first if name != "b")


def test_what_is_fixed_goes_first_and_says_so() -> None:
    for seed in range(20):
        problem = instance({"a": 5.0, "b": 3.0}, both("a", "b", 1.0), [("b", "a")], a={"leader": "b"})
        answer = drawn(seed).order(problem, NoPlanner())
        assert answer.sequence == ("b", "a")
        assert answer.reasons["b", "a"] == "b drives ahead of a"
    free = drawn(0).order(instance({"a": 5.0, "b": 3.0}, both("a", "b", 1.0)), NoPlanner())
    assert [*free.reasons.values()] == [f"{free.sequence[0]} was drawn before {free.sequence[1]}"]


def test_schedules_keep_separations_and_windows() -> None:
    for seed in range(10_000, 10_060):
        problem = crossroads(seed, 2 + seed % 10, windows=True)
        answer = drawn(seed).order(problem, NoPlanner())
        assert is_valid(problem, answer.sequence, dict(answer.times))


def test_lane_changes_are_granted_in_the_drawn_order() -> None:
    requests = [
        Request("a", Action.LANE_LEFT, 1.0, 0.0, frozenset({"b"})),
        Request("b", Action.LANE_LEFT, 9.0, 0.0, frozenset({"a"})),
    ]
    granted = {drawn(seed).grant(requests) for seed in range(20)}
    assert granted == {frozenset({"a"}), frozenset({"b"})}
    problem = instance({"a": 3.0, "b": 3.0}, both("a", "b", 1.0))
    for seed in range(20):
        assert drawn(seed).grant(requests) == {drawn(seed).order(problem, NoPlanner()).sequence[0]}
