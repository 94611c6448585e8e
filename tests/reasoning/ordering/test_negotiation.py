"""Without negotiation each CAV makes up its own order, in three readings."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import Car, Junction, Thoughts, car

from codriving.datatypes.order import PassingOrder
from codriving.reasoning.ordering.negotiation import OwnOrders
from codriving.reasoning.sharing.sharing import OwnOrder

READINGS: tuple[OwnOrder, ...] = ("own_view", "same_rule", "independent")


def orders(thoughts: Thoughts, reading: OwnOrder, seed: int = 0) -> dict[str, PassingOrder]:
    own = OwnOrders(reading, seed)
    return dict(own.orders(thoughts.moment()))


def crossing(junction: Junction, gain: float = 0.0, speeds: tuple[float, float] = (8.0, 8.0)) -> Thoughts:
    """Two CAVs that go straight; the conflict zones of south and east lie equally far."""
    return junction.thoughts(
        car("CAV1", "south-north", 60.0 + gain, speeds[0]), car("CAV2", "west-east", 64.0, speeds[1])
    )


def believed_first(found: dict[str, PassingOrder]) -> tuple[str | None, str | None]:
    return found["CAV1"].first_of("CAV1", "CAV2"), found["CAV2"].first_of("CAV1", "CAV2")


def test_own_view_decides_for_itself_on_both_sides(junction: Junction) -> None:
    # Each knows that it will accelerate and takes the other one to keep its speed.
    for gain in (-3.0, 0.0, 3.0):
        assert believed_first(orders(crossing(junction, gain, (6.0, 6.0)), "own_view")) == ("CAV1", "CAV2")


def test_own_view_sees_who_is_clearly_earlier(junction: Junction) -> None:
    assert believed_first(orders(crossing(junction, 30.0), "own_view")) == ("CAV1", "CAV1")
    assert believed_first(orders(crossing(junction, -30.0), "own_view")) == ("CAV2", "CAV2")


@settings(max_examples=30, deadline=None)
@given(st.floats(-30, 30), st.floats(0, 9), st.floats(0, 9), st.sampled_from(["west-east", "west-north", "east-south"]))
def test_the_same_rule_on_shared_data_agrees(junction: Junction, gain: float, v: float, w: float, other: str) -> None:
    thoughts = junction.thoughts(car("CAV1", "south-north", 60.0 + gain, v), car("CAV2", other, 60.0, w))
    mine, theirs = believed_first(orders(thoughts, "same_rule"))
    assert mine == theirs is not None


def test_the_same_rule_agrees_on_ties_as_well(junction: Junction) -> None:
    (zone,) = junction.road_map.zones("south-north", "west-east")
    thoughts = junction.thoughts(
        car("CAV1", "south-north", zone.entry_i - 40.0, 8.0), car("CAV2", "west-east", zone.entry_j - 40.0, 8.0)
    )
    assert believed_first(orders(thoughts, "same_rule")) == ("CAV1", "CAV1")


def test_the_same_rule_lets_straight_go_before_turning(junction: Junction) -> None:
    thoughts = junction.thoughts(car("CAV1", "south-west", 61.0, 8.0), car("CAV2", "north-south", 60.0, 8.0))
    assert believed_first(orders(thoughts, "same_rule")) == ("CAV2", "CAV2")


def test_independent_guesses_differ_between_cars_and_seeds_but_not_between_runs(junction: Junction) -> None:
    thoughts = crossing(junction)
    guesses = [believed_first(orders(thoughts, "independent", seed)) for seed in range(40)]
    assert guesses == [believed_first(orders(thoughts, "independent", seed)) for seed in range(40)]
    assert {("CAV1", "CAV2"), ("CAV2", "CAV1")} < set(guesses), "inconsistent orders happen"


def test_independent_guesses_are_mostly_right_where_the_difference_is_clear(junction: Junction) -> None:
    thoughts = crossing(junction, 38.0)
    guesses = [believed_first(orders(thoughts, "independent", seed)) for seed in range(40)]
    assert sum(guess == ("CAV1", "CAV1") for guess in guesses) > 30


def test_a_guess_lasts_for_the_episode(junction: Junction) -> None:
    thoughts = crossing(junction)
    own = OwnOrders("independent", 5)
    first = dict(own.orders(thoughts.moment()))
    later = crossing(junction, 38.0)
    again = dict(own.orders(later.moment()))
    assert believed_first(first) == believed_first(again)


@pytest.mark.parametrize("reading", READINGS)
def test_an_order_is_about_ones_own_conflicts_alone(reading: OwnOrder, junction: Junction) -> None:
    cars: list[Car] = [
        car("CAV1", "south-north", 70.0, 8.0),
        car("CAV2", "west-east", 70.0, 8.0),
        car("CAV3", "north-south", 70.0, 8.0),
        car("HDV1", "east-west", 80.0, 8.0),
    ]
    thoughts = junction.thoughts(*cars)
    for ego, order in orders(thoughts, reading).items():
        assert {p.first for p in order.precedences} | {p.second for p in order.precedences} == set(order.sequence)
        assert all(ego in (p.first, p.second) and p.reason.startswith("own estimate") for p in order.precedences)
        assert {p.first for p in order.precedences} | {p.second for p in order.precedences} == {ego} | {
            c.other for c in thoughts.conflicts[ego]
        }
        assert not order.binding


@pytest.mark.parametrize("reading", READINGS)
def test_human_drivers_go_first_unless_the_cav_is_through_before(reading: OwnOrder, junction: Junction) -> None:
    for place, first in ((92.0, "HDV1"), (66.0, "CAV1")):
        thoughts = junction.thoughts(car("CAV1", "south-north", 98.0, 8.0), car("HDV1", "west-east", place, 6.0))
        assert orders(thoughts, reading)["CAV1"].first_of("CAV1", "HDV1") == first


@pytest.mark.parametrize("reading", READINGS)
def test_no_vehicle_to_mind_gives_an_empty_order(reading: OwnOrder, junction: Junction) -> None:
    assert orders(junction.thoughts(car("CAV1", "south-north", 60.0, 8.0)), reading)["CAV1"] == PassingOrder((), ())


@pytest.mark.parametrize("reading", READINGS)
def test_the_sequence_is_that_of_the_order(reading: OwnOrder, junction: Junction) -> None:
    # CAV1 turns: it is there a little earlier, and lets the other one go first all the same.
    for gain in range(-20, 21, 2):
        thoughts = junction.thoughts(
            car("CAV1", "south-west", 60.0 + gain, 8.0),
            car("CAV2", "north-south", 60.0, 8.0),
            car("CAV3", "west-east", 60.0, 8.0),
        )
        for seed in range(5):
            for order in orders(thoughts, reading, seed).values():
                rank = {name: k for k, name in enumerate(order.sequence)}
                assert all(rank[p.first] < rank[p.second] for p in order.precedences)


@settings(max_examples=20, deadline=None)
@given(
    st.lists(
        st.tuples(st.sampled_from(["south-north", "west-east", "east-south", "north-west"]), st.floats(30, 110)),
        min_size=3,
        max_size=6,
    ),
    st.sampled_from(READINGS),
)
def test_an_own_order_leaves_no_vehicle_out_since_every_pair_has_the_cav_in_it(
    junction: Junction, some: list[tuple[str, float]], reading: OwnOrder
) -> None:
    thoughts = junction.thoughts(*[car(f"CAV{k}", route, place, 7.0) for k, (route, place) in enumerate(some)])
    for ego, order in orders(thoughts, reading).items():
        partners = {c.other for c in thoughts.conflicts[ego]}
        assert {frozenset((p.first, p.second)) for p in order.precedences} == {frozenset((ego, k)) for k in partners}


@pytest.mark.parametrize(("gain", "share"), [(-9.0, 0.27), (0.0, 0.50), (9.0, 0.73), (18.0, 0.88)])
def test_a_guess_is_right_the_more_often_the_clearer_the_difference_is(
    gain: float, share: float, junction: Junction
) -> None:
    # At 9 m/s CAV1 is there 1 s earlier for each 9 m that it is nearer: 1 / (1 + exp(-1)) = 0.73.
    thoughts = crossing(junction, gain, (9.0, 9.0))
    said = [orders(thoughts, "independent", seed)["CAV1"].first_of("CAV1", "CAV2") for seed in range(1000)]
    assert said.count("CAV1") / 1000 == pytest.approx(share, abs=0.05)
