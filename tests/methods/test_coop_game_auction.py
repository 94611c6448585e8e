"""The auction: bids, their order, and who keeps its place."""

from itertools import pairwise
from math import inf

import pytest
from coalitions import Scheduled, everybody, instance, problems, vehicle
from hypothesis import given, settings
from hypothesis import strategies as st

from codriving.datatypes.order import Instance
from codriving.datatypes.world import Action
from codriving.errors import ConfigError
from codriving.methods.coop_game_auction import Auction, bid, overtaken
from codriving.reasoning.ordering.protocol import Request


def test_bid_is_the_formula() -> None:
    assert bid(vehicle("a", 2, distance=18.0, speed=9.0), 4.0) == pytest.approx(0.4 + 3 / 20 + 1 / 2.5)


def test_no_vehicle_bids_without_end() -> None:
    assert bid(vehicle("a", 0, distance=0.0, speed=0.0), 0.0) == pytest.approx(3 / 2 + 1 / 0.5)
    assert bid(vehicle("a", 0, distance=10.0, speed=0.0), 0.0) == bid(vehicle("a", 0, distance=10.0, speed=0.5), 0.0)


def test_highest_bid_goes_first() -> None:
    problem = instance(vehicle("a", 4), vehicle("b", 2), vehicle("c", 3), conflicts=everybody("abc"))
    ordering = Auction(0.1).order(problem, Scheduled(problem))
    assert ordering.sequence == ("b", "c", "a")
    assert list(ordering.times) == ["b", "c", "a"]
    assert "bids" in ordering.reasons["b", "a"]


def test_waiting_counts_from_the_moment_of_standing() -> None:
    """A vehicle farther away overtakes a nearer one in the end, since it has waited longer."""
    auction = Auction(0.0)
    firsts = []
    for step in range(40):
        far = vehicle("far", 3, distance=30.0, speed=0.2)
        near = vehicle("near", 1, distance=10.0, speed=0.2 if step >= 20 else 5.0)
        problem = instance(far, near, conflicts=[("far", "near")], time=step * 0.5)
        firsts.append(auction.order(problem, Scheduled(problem)).sequence[0])
    assert firsts[0] == "near"
    # 0.1 a second has to make up for the nearer place and the earlier arrival.
    ahead = bid(near, 0.0) - bid(far, 0.0)
    moving = bid(vehicle("near", 1, distance=10.0, speed=5.0), 0.0) - bid(far, 0.0)
    assert ahead / 0.1 < 10.0
    assert firsts[: int(moving / 0.1 / 0.5) + 1] == ["near"] * (int(moving / 0.1 / 0.5) + 1)
    assert firsts[-1] == "far"


def test_waiting_ends_with_driving_on() -> None:
    auction = Auction(0.0)
    for time, speed in ((0.0, 0.0), (5.0, 3.0), (6.0, 0.0), (8.0, 0.0)):
        problem = instance(vehicle("a", 2, speed=speed, distance=20.0), time=time)
        auction.order(problem, Scheduled(problem))
    assert auction._wait(problem) == {"a": 2.0}
    auction.reset(0)
    assert auction._wait(problem) == {"a": 0.0}


@pytest.mark.parametrize(("hysteresis", "first"), [(0.0, "b"), (0.2, "a")])
def test_order_stays_unless_enough_more_is_bid(hysteresis: float, first: str) -> None:
    auction = Auction(hysteresis)
    for b in (2.2, 1.9):
        problem = instance(vehicle("a", 2.0), vehicle("b", b), conflicts=[("a", "b")])
        ordering = auction.order(problem, Scheduled(problem))
    assert ordering.sequence[0] == first
    assert ordering.counts["kept"] == (first == "a")
    assert ("went first before" in ordering.reasons["a", "b"]) if first == "a" else True


def test_order_that_cannot_be_kept_any_more_is_given_up() -> None:
    auction = Auction(5.0)
    for b in (2.2, 1.9):
        problem = instance(vehicle("a", 2.0), vehicle("b", b), conflicts=[("a", "b")])
        ordering = auction.order(problem, Scheduled(problem, lambda order: order[0] == "b"))
    assert ordering.sequence == ("b", "a")


@given(st.dictionaries(st.text("abcdef", min_size=1, max_size=1), st.floats(0, 5), min_size=1), st.floats(0, 1))
def test_no_vehicle_stays_behind_who_bids_enough_more(bids: dict[str, float], by: float) -> None:
    order = overtaken(sorted(bids), bids, by)
    assert sorted(order) == sorted(bids)
    assert all(bids[b] <= bids[a] + by for a, b in pairwise(order))


@settings(max_examples=50)
@given(problems(), problems())
def test_order_respects_what_is_fixed_and_is_repeatable(first: Instance, second: Instance) -> None:
    def drive() -> list[tuple[str, ...]]:
        auction = Auction(0.1)
        auction.reset(3)
        return [auction.order(problem, Scheduled(problem)).sequence for problem in (first, second)]

    sequences = drive()
    for problem, sequence in zip((first, second), sequences, strict=True):
        assert sorted(sequence) == sorted(problem.vehicles)
        assert all(sequence.index(a) < sequence.index(b) for a, b in problem.before)
    assert drive() == sequences


def test_lane_changes_that_gain_most_together_are_granted() -> None:
    requests = [
        Request("a", Action.LANE_LEFT, 1.0, 0.0, frozenset("b")),
        Request("b", Action.LANE_LEFT, inf, 1.0, frozenset("a")),
    ]
    assert Auction(0.1).grant(requests) == {"b"}


def test_hysteresis_out_of_range_is_refused() -> None:
    with pytest.raises(ConfigError, match="hysteresis must be 0 to 10, got -1"):
        Auction(-1.0)
