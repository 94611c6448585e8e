"""The numbers of a pair, on both sides of each bound: learned weights are worth nothing if one of them drifts."""

import pytest
from worlds import Car, Junction, car

from codriving.judgement.contests import FEATURES, Contest, contests

CAV, HUMAN = car("CAV1", "east-west", 80, 8, 9), car("HDV1", "south-north", 76, 8, pedal=-1.5)


def pair(junction: Junction, *cars: Car) -> Contest:
    [found] = contests(junction.thoughts(*cars).moment())
    return found


def test_numbers_of_one_pair(junction: Junction) -> None:
    """The driver may turn onto the CAV's road, whose zone is the most urgent one."""
    found = pair(junction, CAV, HUMAN)
    assert (found.way, found.follows) == ("south-west", "")
    assert found.numbers.keys() == FEATURES.keys()
    assert found.numbers == pytest.approx(
        {
            **{"cav_distance": 29.445, "cav_speed": 8.0, "cav_time": 3.341, "time_ahead": 4.086 - 3.341},
            **{"human_distance": 32.689, "human_speed": 8.0, "human_time": 32.689 / 8, "human_acceleration": -1.5},
            **{"human_braking": 64 / (2 * (32.689 - 2.5)), "human_standing": 0.0, "human_occupies": 10.0},
            **{"ways": 3.0, "priority": 1.0, "converging": 1.0, "cav_turns": 0.0},
            **dict.fromkeys(("cav_committed", "cav_in_junction", "cav_held_up"), 0.0),
            **dict.fromkeys(("human_in_junction", "human_held_up"), 0.0),
        },
        abs=0.002,
    )


def test_a_cav_that_turns_and_has_to_give_way(junction: Junction) -> None:
    numbers = pair(junction, car("CAV1", "south-west", 80, 8, 9), car("HDV1", "east-west", 76, 8)).numbers
    assert (numbers["priority"], numbers["cav_turns"]) == (-1.0, 1.0)


@pytest.mark.parametrize(
    ("place", "speed", "follows", "held_up"),
    [(100, 6.9, "CAV2", 1.0), (101.1, 6.9, "", 0.0), (100, 7.1, "CAV2", 0.0)],
)
def test_a_driver_is_held_up_by_a_slower_vehicle_within_25_m(
    place: float, speed: float, follows: str, held_up: float, junction: Junction
) -> None:
    found = pair(junction, CAV, HUMAN, car("CAV2", "south-north", place, speed, 7))
    assert (found.follows, found.numbers["human_held_up"], found.numbers["cav_held_up"]) == (follows, held_up, 0.0)


@pytest.mark.parametrize(("place", "speed", "held_up"), [(109.9, 6.9, 1.0), (110.1, 6.9, 0.0), (100, 7.1, 0.0)])
def test_a_cav_is_held_up_by_a_slower_vehicle_within_25_m(
    place: float, speed: float, held_up: float, junction: Junction
) -> None:
    numbers = pair(junction, CAV, HUMAN, car("CAV3", "east-west", place, speed, 7)).numbers
    assert (numbers["cav_held_up"], numbers["human_held_up"]) == (held_up, 0.0)


@pytest.mark.parametrize(
    ("place", "speed", "human", "committed", "human_inside"), [(104, 8, 96, 1.0, 0.0), (104, 5, 98, 0.0, 1.0)]
)
def test_who_is_in_the_junction_and_who_can_still_stop(
    place: float, speed: float, human: float, committed: float, human_inside: float, junction: Junction
) -> None:
    cars = car("CAV1", "east-west", place, speed, 9), car("HDV1", "south-north", human, speed)
    numbers = pair(junction, *cars).numbers
    assert (numbers["cav_committed"], numbers["cav_in_junction"]) == (committed, 1.0)
    assert numbers["human_in_junction"] == human_inside
