"""Who goes first: never both by the same way, ties are resolved, and the vehicle that cannot wait any more does not."""

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from seeing import seen
from worlds import Car, Junction, car

from codriving.methods.single_vehicle.encounters import Encounter, encounters, goes_first

LEGS = ("south", "west", "north", "east")
ROUTES = tuple(f"{a}-{b}" for a in LEGS for b in LEGS if a != b)
FIRM, TIE = 2.0, 0.3


def first(junction: Junction, one: Car, other: Car) -> dict[str, tuple[bool, str]]:
    """Whether each goes first, on the ways that both really take."""
    found = {}
    for me, you in ((one, other), (other, one)):
        for e in encounters(*seen(junction, one, other, ego=me.id), FIRM):
            if _real(e, me, you):
                found[me.id] = goes_first(e, junction.road_map, TIE)
    return found


def _real(e: Encounter, me: Car, you: Car) -> bool:
    return e.conflict.routes == (me.route, you.route)


ways = st.tuples(st.sampled_from(ROUTES), st.floats(60.0, 118.0), st.floats(0.0, 9.0))


@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.filter_too_much])
@given(ways, ways)
def test_two_never_both_go_first(
    junction: Junction, one: tuple[str, float, float], other: tuple[str, float, float]
) -> None:
    """Where each can stop is known to itself alone; the rest holds for those of whom the other judges alike."""
    cars = car("CAV1", *one), car("CAV2", *other)
    found = first(junction, *cars)
    assume(len(found) == 2)
    bound = {
        me.id: next(
            (e.bound, e.other_bound) for e in encounters(*seen(junction, *cars, ego=me.id), FIRM) if _real(e, me, you)
        )
        for me, you in (cars, cars[::-1])
    }
    alike = bound["CAV1"] == bound["CAV2"][::-1]
    assert not (found["CAV1"][0] and found["CAV2"][0] and alike)


@pytest.mark.parametrize(
    ("one", "other", "winner"),
    [
        (("south-north", 84.0, 7.0), ("west-east", 80.0, 7.0), "CAV1"),
        (("south-north", 80.0, 7.0), ("west-east", 90.0, 7.0), "CAV2"),
        (("south-north", 80.0, 3.0), ("west-east", 80.0, 7.0), "CAV2"),
        (("south-north", 108.0, 2.0), ("west-east", 80.0, 9.0), "CAV1"),
    ],
)
def test_who_is_there_earlier_goes_first(
    one: tuple[str, float, float], other: tuple[str, float, float], winner: str, junction: Junction
) -> None:
    found = first(junction, car("CAV1", *one), car("CAV2", *other))
    assert {name: goes for name, (goes, _) in found.items()} == {"CAV1": winner == "CAV1", "CAV2": winner == "CAV2"}


def test_at_once_who_comes_from_the_right_goes_first(junction: Junction) -> None:
    # The vehicle from the south has the one from the east on its right.
    found = first(junction, car("CAV1", "south-north", 84.0, 7.0), car("CAV2", "east-west", 80.0, 7.0))
    assert found["CAV1"] == (False, "CAV2 comes from the right")
    assert found["CAV2"] == (True, "CAV1 comes from the left")


def test_at_once_from_opposite_sides_names_decide(junction: Junction) -> None:
    (zone,) = junction.road_map.zones("south-west", "north-south")
    turning = car("CAV2", "south-west", zone.entry_i - 16.0, 7.0)
    found = first(junction, turning, car("CAV1", "north-south", zone.entry_j - 16.0, 7.0))
    assert found["CAV1"] == (True, "both are there at once, and names decide")
    assert found["CAV2"] == (False, "both are there at once, and names decide")


def test_a_vehicle_that_would_have_to_brake_hard_is_not_expected_to_wait(junction: Junction) -> None:
    # The CAV would be there at about the same time and comes from the right, but can still wait; HDV1 cannot.
    cars = (car("CAV1", "south-north", 99.0, 3.0), car("HDV1", "west-east", 92.0, 9.0))
    (e,) = [e for e in encounters(*seen(junction, *cars), FIRM) if e.conflict.routes[1] == "west-east"]
    assert (e.bound, e.other_bound) == (False, True)
    assert goes_first(e, junction.road_map, TIE) == (False, "HDV1 cannot be expected to stop")


def test_a_vehicle_that_is_in_the_zone_goes_first(junction: Junction) -> None:
    found = first(junction, car("CAV1", "south-north", 106.0, 1.0), car("CAV2", "west-east", 107.0, 9.0))
    assert found == {"CAV1": (True, "it is there already"), "CAV2": (False, "CAV1 is there already")}
