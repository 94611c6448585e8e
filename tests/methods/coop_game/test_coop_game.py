"""The cooperative game: what streams agree on."""

from itertools import permutations
from math import exp, inf
from typing import Any

import numpy as np
import pytest
from coalitions import GAME, SAMPLE, STEPS, TOP, Scheduled, everybody, instance, payoff, problems, vehicle
from hypothesis import given, settings
from hypothesis import strategies as st

from codriving.datatypes.order import ApproachingVehicle, Instance
from codriving.datatypes.world import Action
from codriving.errors import ConfigError
from codriving.methods.coop_game.coop_game import CoopGame
from codriving.methods.coop_game.payoff import Goal, Scale, on_one_scale
from codriving.reasoning.ordering.protocol import JointPlan, Ordering, Request
from codriving.reasoning.ordering.schedule import repaired
from codriving.reasoning.ordering.tickets import TicketBook


def game(**change: Any) -> CoopGame:
    made = CoopGame(**{**GAME, **change})
    made.reset(0)
    return made


def value(problem: Instance, order: tuple[str, ...], objective: Goal = Goal.INVERSE_DISTANCE) -> float:
    """What an order is worth to all together, worked out anew."""
    planner = Scheduled(problem)
    return sum(payoff(objective).of(problem, planner.plan(order), planner).values())


def crossing(*cars: ApproachingVehicle) -> Instance:
    """Vehicles that all conflict."""
    return instance(*cars, conflicts=everybody([car.id for car in cars]))


def first_come(problem: Instance) -> tuple[str, ...]:
    return tuple(TicketBook(GAME["control_radius"]).ranking(problem))


@pytest.mark.parametrize("objective", list(Goal))
@pytest.mark.parametrize("etas", [(3.0, 3.0), (2.0, 3.5), (6.0, 1.0)])
def test_two_gain_together_what_they_would_alone_or_more(objective: Goal, etas: tuple[float, float]) -> None:
    """Superadditivity: v({a, b}) >= v({a}) + v({b}), alone meaning first come, first served, or at the worst last."""
    problem = crossing(vehicle("a", etas[0]), vehicle("b", etas[1]))
    planner = Scheduled(problem)
    together = value(problem, game(objective=objective).order(problem, planner).sequence, objective)
    payoffs = [payoff(objective).of(problem, planner.plan(order), planner) for order in permutations("ab")]
    assert together == max(sum(p.values()) for p in payoffs)
    assert together >= sum(min(p[name] for p in payoffs) for name in "ab")
    assert together >= value(problem, first_come(problem), objective)


def test_agreeing_can_be_worth_more_than_coming_first() -> None:
    """The vehicle that comes a little later but is much nearer to its destination goes first."""
    problem = crossing(vehicle("a", 3.0, remaining=200.0), vehicle("b", 3.1, remaining=40.0))
    ordering = game().order(problem, Scheduled(problem))
    assert first_come(problem) == ("a", "b")
    assert ordering.sequence == ("b", "a")
    assert value(problem, ordering.sequence) > value(problem, ("a", "b"))


def test_turning_yields_to_straight_where_drivers_would_be_indifferent() -> None:
    """At d_turn = 1.44 d_gs - 25.4 both count as equally far; straight gains more from going first."""
    straight = 90.0
    cars = (
        vehicle("a", 4.0, turning=True, remaining=1.44 * straight - 25.4),
        vehicle("b", 4.0, remaining=straight),
    )
    assert game().order(crossing(*cars), Scheduled(crossing(*cars))).sequence == ("b", "a")
    # Without a common scale the shorter way would win, whichever vehicle turns.
    cars = (vehicle("a", 4.0, turning=True, remaining=90.0), vehicle("b", 4.0, remaining=90.5))
    problem = crossing(*cars)
    assert game(scale="none").order(problem, Scheduled(problem)).sequence == ("a", "b")
    assert game().order(problem, Scheduled(problem)).sequence == ("b", "a")


@given(st.floats(20.0, 500.0))
def test_both_scales_have_the_indifference_of_the_source(straight: float) -> None:
    turning = 1.44 * straight - 25.4
    for scale in (Scale.TURNING, Scale.STRAIGHT):
        assert on_one_scale(turning, True, scale) == pytest.approx(max(on_one_scale(straight, False, scale), 1.0))
    assert on_one_scale(turning, True, Scale.NONE) == max(turning, 1.0)


def test_distances_count_as_one_metre_at_least() -> None:
    for scale in Scale:
        assert min(on_one_scale(d, turning, scale) for d in (0.0, 0.5, 10.0) for turning in (False, True)) >= 1.0


@pytest.mark.parametrize("turning", [False, True])
def test_distances_are_as_they_are_where_all_turn_or_none(turning: bool) -> None:
    problem = crossing(vehicle("a", 3, turning=turning), vehicle("b", 4, turning=turning))
    planner = Scheduled(problem)
    plan = planner.plan(("a", "b"))
    assert payoff().of(problem, plan, planner) == payoff(scale=Scale.NONE).of(problem, plan, planner)
    mixed = crossing(vehicle("a", 3, turning=True), vehicle("b", 4))
    assert payoff().of(mixed, plan, planner)["a"] != payoff(scale=Scale.NONE).of(mixed, plan, planner)["a"]
    assert payoff().of(mixed, plan, planner)["b"] == payoff(scale=Scale.NONE).of(mixed, plan, planner)["b"]


def test_inverse_distance_is_that_of_the_mean() -> None:
    problem = instance(vehicle("a", 0.0, remaining=54.0))
    travel = np.arange(STEPS + 1) * SAMPLE * TOP
    plan = JointPlan(True, {"a": travel}, SAMPLE)
    left = np.maximum(54.0 - travel, 0.0).mean()
    assert payoff().of(problem, plan, Scheduled(problem)) == {"a": pytest.approx(1 / left)}


class Gap:
    """A planner that only knows one gap in time."""

    def __init__(self, gap: float) -> None:
        self.gap = gap

    def plan(self, order: Any) -> JointPlan:
        """It is not asked."""
        raise AssertionError

    def gap_time(self, plan: JointPlan, one: str, other: str) -> float:
        """The gap, whichever vehicle is meant."""
        return self.gap


@pytest.mark.parametrize(("gap", "risk"), [(inf, 0.0), (1.5, exp(-1)), (0.0, 1.0), (-2.0, 1.0)])
def test_utility_weighs_way_acceleration_and_risk(gap: float, risk: float) -> None:
    problem = crossing(vehicle("a", 1.0, remaining=100.0), vehicle("b", 1.0, remaining=100.0))
    times = np.arange(STEPS + 1) * SAMPLE
    plan = JointPlan(True, {"a": times**2 / 2, "b": times}, SAMPLE)
    found = payoff(Goal.UTILITY).of(problem, plan, Gap(gap))
    way = (times**2 / 2).mean() / 100
    assert found["a"] == pytest.approx((8.2 * way - 1.72 / 16 - 5.7 * risk) / (8.2 + 1.72 + 5.7))
    assert found["b"] == pytest.approx((8.2 * times.mean() / 100 - 5.7 * risk) / (8.2 + 1.72 + 5.7))


def test_four_streams_that_all_conflict_get_four_levels() -> None:
    problem = crossing(*(vehicle(name, 3.0) for name in "abcd"))
    planner = Scheduled(problem)
    ordering = game().order(problem, planner)
    assert sorted(planner.asked) == sorted(permutations("abcd"))
    assert ordering.counts == {
        "orders": 24, "infeasible": 0, "enumerated": 1, "fallback": 0, "kept": 0, "worse_off": 0
    }  # fmt: skip


def test_with_levels_bounded_two_share_one_and_go_as_they_came() -> None:
    problem = crossing(*(vehicle(name, 3.0 + k) for k, name in enumerate("abcd")))
    planner = Scheduled(problem)
    ordering = game(levels=2).order(problem, planner)
    assert ordering.counts["orders"] == len(planner.asked) < 24
    # Three levels leave one pair of four as they came; that all four are turned round is not among the orders.
    assert ("d", "c", "b", "a") not in planner.asked
    assert set(planner.asked) < set(permutations("abcd"))


def test_streams_without_conflict_are_not_enumerated() -> None:
    problem = instance(*(vehicle(n, 3.0) for n in "abcd"), conflicts=[("a", "b"), ("c", "d")])
    planner = Scheduled(problem)
    game().order(problem, planner)
    assert len(planner.asked) == 4


def test_nothing_is_asked_if_there_is_nothing_to_agree_on() -> None:
    problem = instance(vehicle("a", 4), vehicle("b", 2), vehicle("c", 3), before=[("a", "c")])
    planner = Scheduled(problem)
    ordering = game().order(problem, planner)
    assert ordering.sequence == ("b", "a", "c")
    assert (planner.asked, ordering.counts) == ([], {"orders": 0})
    assert game().order(instance(), planner) == Ordering((), {}, {}, {"orders": 0})


@settings(max_examples=60)
@given(problems(), st.data())
def test_what_cannot_be_driven_is_never_agreed_on_if_something_else_can(problem: Instance, data: st.DataObject) -> None:
    """A collision is not a price: whatever an order that is not feasible would be worth, it is not taken."""
    allowed: dict[tuple[str, ...], bool] = {}

    def works(order: tuple[str, ...]) -> bool:
        return allowed.setdefault(order, data.draw(st.booleans()))

    planner = Scheduled(problem, works)
    ordering = game(evaluations=1000).order(problem, planner)
    if ordering.counts["orders"]:
        assert ordering.counts["fallback"] == (not any(allowed.values()))
        assert allowed[ordering.sequence] or not any(allowed.values())
        if not any(allowed.values()):
            assert ordering.sequence == first_come(problem)


@settings(max_examples=60)
@given(problems(), st.sampled_from(list(Goal)), st.sampled_from([None, 1, 2]), st.sampled_from([2, 5, 60]))
def test_never_worse_than_first_come_and_within_the_limit(
    problem: Instance, objective: Goal, levels: int | None, evaluations: int
) -> None:
    planner = Scheduled(problem)
    ordering = game(objective=objective, levels=levels, evaluations=evaluations).order(problem, planner)
    assert sorted(ordering.sequence) == sorted(problem.vehicles)
    assert list(ordering.times) == list(ordering.sequence)
    assert all(ordering.sequence.index(a) < ordering.sequence.index(b) for a, b in problem.before)
    assert all(ordering.sequence.index(a) < ordering.sequence.index(b) for a, b in ordering.reasons)
    assert ordering.counts["orders"] == len(planner.asked) == len(set(planner.asked)) <= evaluations
    assert value(problem, ordering.sequence, objective) >= value(problem, first_come(problem), objective) - 1e-9


@settings(max_examples=40)
@given(problems(most=4))
def test_enumeration_finds_the_best_order_of_single_vehicles(problem: Instance) -> None:
    """With one vehicle a stream, levels are orders: the game is exact."""
    for one in problem.vehicles.values():
        one.stream = one.id
    ordering = game().order(problem, Scheduled(problem))
    orders = {tuple(repaired(problem, ranking)) for ranking in permutations(sorted(problem.vehicles))}
    assert value(problem, ordering.sequence) == pytest.approx(max(value(problem, order) for order in orders))


@settings(max_examples=30)
@given(st.lists(problems(), min_size=2, max_size=3))
def test_same_steps_give_the_same_orders(steps: list[Instance]) -> None:
    def drive(rule: CoopGame) -> list[Ordering]:
        rule.reset(1)
        return [rule.order(problem, Scheduled(problem)) for problem in steps]

    rule = game()
    assert drive(rule) == drive(game()) == drive(rule)


def test_climbing_gets_far_with_few_orders() -> None:
    """Six streams that all conflict have 720 orders; with 60 of them the game gets near the best."""
    ratios = []
    for seed in range(4):
        rng = np.random.default_rng(seed)
        problem = crossing(*(vehicle(f"v{k}", e, remaining=r) for k, (e, r) in enumerate(rng.uniform(3, 90, (6, 2)))))
        for one in problem.vehicles.values():
            one.eta = one.eta % 6
            one.distance = one.eta * TOP
            one.remaining += one.distance
        ordering = game().order(problem, Scheduled(problem))
        best = max(value(problem, order) for order in permutations(sorted(problem.vehicles)))
        start = value(problem, first_come(problem))
        assert ordering.counts["enumerated"] == 0
        assert ordering.counts["orders"] <= 60
        ratios.append((value(problem, ordering.sequence) - start) / (best - start))
    assert min(ratios) > 0.7


@pytest.mark.parametrize(("hysteresis", "kept"), [(0.0, 0), (1.0, 1)])
def test_order_stays_unless_another_one_is_worth_enough_more(hysteresis: float, kept: int) -> None:
    rule = game(hysteresis=hysteresis)
    for remaining in (80.0, 76.0):
        problem = crossing(vehicle("a", 3.0, remaining=78.0), vehicle("b", 3.0, remaining=remaining))
        ordering = rule.order(problem, Scheduled(problem))
    assert ordering.counts["kept"] == kept
    assert ordering.sequence == (("a", "b") if kept else ("b", "a"))


def test_order_that_cannot_be_kept_any_more_is_given_up() -> None:
    rule = game(hysteresis=10.0)
    problem = crossing(vehicle("a", 3.0, remaining=78.0), vehicle("b", 3.0, remaining=80.0))
    assert rule.order(problem, Scheduled(problem)).sequence == ("a", "b")
    assert rule.order(problem, Scheduled(problem, lambda order: order[0] == "b")).sequence == ("b", "a")


def test_a_vehicle_that_would_lose_is_counted_and_can_refuse() -> None:
    problem = crossing(vehicle("a", 3.0, remaining=200.0), vehicle("b", 3.1, remaining=40.0))
    ordering = game().order(problem, Scheduled(problem))
    assert (ordering.sequence, ordering.counts["worse_off"]) == (("b", "a"), 1)
    ordering = game(rational=True).order(problem, Scheduled(problem))
    assert (ordering.sequence, ordering.counts["worse_off"]) == (("a", "b"), 0)


def test_equal_worth_goes_to_the_smaller_delay_and_then_to_the_lower_levels() -> None:
    """All are at their destination already, so that only the delay is left."""
    cars = [
        vehicle(n, eta, remaining=0.0, stream=s) for n, eta, s in (("a", 1.0, "s"), ("b", 1.5, "t"), ("c", 2.0, "s"))
    ]
    problem = instance(*cars, conflicts=[("a", "b"), ("c", "b")], before=[("a", "c")], apart=2.0)
    problem = Instance(0.0, problem.vehicles, {**problem.separation, ("a", "c"): 0.5}, problem.before)
    assert game().order(problem, Scheduled(problem)).sequence == ("a", "c", "b")
    twins = crossing(vehicle("a", 2.0, remaining=0.0), vehicle("b", 2.0, remaining=0.0))
    assert game().order(twins, Scheduled(twins)).sequence == ("a", "b")


def test_reasons_tell_what_the_group_gains() -> None:
    problem = crossing(vehicle("a", 3.0, remaining=200.0), vehicle("b", 3.1, remaining=40.0))
    assert "on level 0" in game().order(problem, Scheduled(problem)).reasons["b", "a"]
    stuck = game().order(problem, Scheduled(problem, lambda order: False))
    assert "earlier ticket" in stuck.reasons["a", "b"]


def test_lane_changes_that_gain_most_together_are_granted() -> None:
    requests = [
        Request("a", Action.LANE_LEFT, 1.0, 0.0, frozenset("b")),
        Request("b", Action.LANE_LEFT, 2.0, 1.0, frozenset("a")),
    ]
    assert game().grant(requests) == {"b"}


@pytest.mark.parametrize(
    ("change", "variant"),
    [
        ({}, ""),
        ({"levels": 2}, "levels=2"),
        ({"objective": "utility"}, "utility"),
        (
            {"levels": 2, "objective": "utility", "scale": "none", "rational": True},
            "levels=2, utility, scale=none, rational",
        ),
    ],
)
def test_variant_names_what_differs(change: dict[str, Any], variant: str) -> None:
    assert (game(**change).name, game(**change).variant) == ("coop_game", variant)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"objective": "speed"}, "objective must be inverse_distance or utility, got speed"),
        ({"scale": "left"}, "scale must be turning or straight or none, got left"),
        ({"levels": 0}, "levels must be 1 to 20, got 0"),
        ({"evaluations": 1}, "evaluations must be 2 to 10000, got 1"),
        ({"hysteresis": -0.1}, "hysteresis must be 0 to 10 s, got -0.1"),
        ({"safety": -1}, "safety must be 0 to 100, got -1"),
        ({"efficiency": 0, "comfort": 0, "safety": 0}, "must not all be 0"),
        ({"reference_acceleration": 0}, "reference_acceleration must be 0.1 to 20 m/s2, got 0"),
        ({"risk_time": 0}, "risk_time must be 0.1 to 10 s, got 0"),
        ({"control_radius": 0}, "control_radius must be 1 to 1000 m, got 0"),
    ],
)
def test_settings_out_of_range_are_refused(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ConfigError, match=message):
        game(**change)


def test_where_no_order_can_be_kept_by_all_the_one_with_the_fewest_who_cannot_is_taken() -> None:
    problem = crossing(*(vehicle(name, 3.0) for name in "abc"))

    class Stuck(Scheduled):
        """No order works; in those that begin with c one vehicle has no plan, in all others two have none."""

        def plan(self, order: Any) -> JointPlan:
            found = super().plan(order)
            return JointPlan(False, found.travels, found.sample, 1 if order[0] == "c" else 2)

    assert game().order(problem, Stuck(problem)).sequence[0] == "c"
