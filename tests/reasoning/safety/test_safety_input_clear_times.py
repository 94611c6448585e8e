"""When a conflict zone is expected to be free."""

import math

import pytest
from worlds import Junction, car, order_of

from codriving.reasoning.safety.safety_input import clear_time

CARS = car("CAV1", "south-north", 60.0, 6.0), car("CAV2", "west-east", 80.0, 9.0)


def test_who_goes_first_need_not_wait(junction: Junction) -> None:
    given = junction.safety_input(*CARS, order=order_of("CAV1 CAV2"))
    assert clear_time(given, given.conflicts[0]) == 0


def test_who_goes_second_waits_until_the_other_one_has_left(junction: Junction) -> None:
    given = junction.safety_input(*CARS, order=order_of("CAV2 CAV1"))
    (zone,) = junction.road_map.zones("west-east", "south-north")
    at_top_speed = (zone.exit_i - 80.0) / 9.0
    time = clear_time(given, given.conflicts[0])
    assert at_top_speed <= time <= at_top_speed + given.forecast.sample


def test_behind_a_vehicle_that_merges_the_zone_need_not_be_left(junction: Junction) -> None:
    cars = CARS[0], car("CAV2", "west-north", 80.0, 9.0)
    given = junction.safety_input(*cars, order=order_of("CAV2 CAV1"))
    (zone,) = junction.road_map.zones("west-north", "south-north")
    assert zone.merge_i is not None
    time = clear_time(given, given.conflicts[0])
    assert (zone.merge_i - 80.0) / 9.0 < time < (zone.exit_i - 80.0) / 9.0


@pytest.mark.parametrize(("place", "time"), [(80.0, 4.8), (95.0, 3.2), (100.0, 2.6)])
def test_behind_one_that_has_merged_the_way_is_free_a_car_length_down_the_common_road(
    place: float, time: float, junction: Junction
) -> None:
    # The common road begins at 118.0 m: at 9 m/s it is at 123.0 m after 4.77, 3.11 and 2.55 s; a sample is 0.2 s.
    given = junction.safety_input(CARS[0], car("CAV2", "west-north", place, 9.0), order=order_of("CAV2 CAV1"))
    assert clear_time(given, given.conflicts[0]) == pytest.approx(time)


def test_never_behind_one_who_stands_in_the_way(junction: Junction) -> None:
    given = junction.safety_input(CARS[0], car("HDV1", "west-east", 112.0, 0.0), order=order_of("HDV1 CAV1"))
    straight = next(c for c in given.conflicts if c.routes[1] == "west-east")
    assert clear_time(given, straight) == math.inf


@pytest.mark.parametrize("place", [60.0, 80.0, 95.0])
def test_the_nearer_the_other_one_the_sooner(place: float, junction: Junction) -> None:
    near, far = (
        junction.safety_input(CARS[0], car("CAV2", "west-east", s, 9.0), order=order_of("CAV2 CAV1"))
        for s in (place, 40.0)
    )
    assert clear_time(near, near.conflicts[0]) < clear_time(far, far.conflicts[0])
