"""What is known of a human driver, and what follows from each action, with numbers written out."""

from dataclasses import replace

import pytest
from worlds import Junction, Thoughts, car

from codriving.briefing.briefing import Briefing
from codriving.datatypes.outlook import HumanOutlook
from codriving.datatypes.world import Action


def human(thoughts: Thoughts) -> HumanOutlook:
    briefing = Briefing()
    briefing.note(thoughts.moment())
    [found] = briefing.outlook(thoughts.safety_input("CAV1")).humans
    return found


def test_braking_to_stop_before_the_zone(junction: Junction) -> None:
    thoughts = junction.thoughts(car("CAV1", "south-north", 80, 8, 9), car("HDV1", "east-west", 76, 8, pedal=-1.5))
    c = thoughts.conflicts["CAV1"][0]
    found = human(thoughts)
    assert found.braking == pytest.approx(64 / (2 * c.distances[1]))
    assert (found.speed, found.acceleration, found.speed_before) == (8.0, -1.5, None)
    assert "straight" in found.turns
    assert found.behind == ""


def test_who_goes_first_by_rule_follows_the_priority_of_the_lanes(junction: Junction) -> None:
    north = car("CAV1", "south-north", 80, 8, 9), car("HDV1", "east-west", 76, 8)
    east = car("CAV1", "east-west", 80, 8, 9), car("HDV1", "south-north", 76, 8)
    assert {human(junction.thoughts(*cars)).first_by_rule for cars in (north, east)} == {"you", "it"}


def test_whom_it_follows(junction: Junction) -> None:
    found = human(
        junction.thoughts(
            car("CAV1", "south-north", 80, 8, 9), car("HDV1", "east-west", 76, 8), car("CAV2", "east-west", 96, 8)
        )
    )
    assert (found.behind, found.gap) == ("CAV2", pytest.approx(15.0))


def test_speed_of_a_second_ago_is_that_and_no_older_one(junction: Junction) -> None:
    cars = car("CAV1", "south-north", 80, 8, 9), car("HDV1", "east-west", 76, 8)
    briefing = Briefing()
    for time, speed in ((0.0, 9.0), (0.5, 8.5), (1.0, 8.25), (1.5, 8.0)):
        briefing.note(junction.thoughts(cars[0], replace(cars[1], speed=speed)).moment(time))
    given = junction.thoughts(*cars).safety_input("CAV1")
    [found] = briefing.outlook(replace(given, moment=replace(given.moment, time=1.5))).humans
    assert found.speed_before == 8.5


def test_speed_of_a_driver_that_was_long_unseen_is_not_told_as_that_of_a_second_ago(junction: Junction) -> None:
    cars = car("CAV1", "south-north", 80, 8, 9), car("HDV1", "east-west", 76, 8)
    for last, told in ((0.5, 9.0), (0.4, None)):
        briefing = Briefing()
        for time, speed in ((last, 9.0), (2.0, 8.0)):
            briefing.note(junction.thoughts(cars[0], replace(cars[1], speed=speed)).moment(time))
        given = junction.thoughts(*cars).safety_input("CAV1")
        [found] = briefing.outlook(replace(given, moment=replace(given.moment, time=2.0))).humans
        assert found.speed_before == told


def test_actions_tell_when_the_zone_is_reached_at_their_speed(junction: Junction) -> None:
    thoughts = junction.thoughts(car("CAV1", "south-north", 60, 6, 6), car("CAV2", "east-west", 50, 6, 6))
    given = thoughts.safety_input("CAV1")
    found = {a.action: a for a in Briefing().outlook(given).actions}
    [c] = given.conflicts
    assert found[Action.IDLE].arrivals[0] == pytest.approx(c.distances[0] / 6.0)
    assert found[Action.FASTER].arrivals[0] < found[Action.IDLE].arrivals[0] < found[Action.SLOWER].arrivals[0]
    assert all(a.stops == (True,) for a in found.values())
    near = junction.thoughts(car("CAV1", "south-north", 97, 9, 9), car("CAV2", "east-west", 50, 6, 6))
    assert not any(a.stops[0] for a in Briefing().outlook(near.safety_input("CAV1")).actions)


def test_braking_of_the_one_behind_is_told(junction: Junction) -> None:
    close = junction.thoughts(car("CAV1", "south-north", 60, 6, 6), car("HDV1", "south-north", 50, 9))
    found = {a.action: a for a in Briefing().outlook(close.safety_input("CAV1")).actions}
    assert {a.follower for a in found.values()} == {"HDV1"}
    assert found[Action.SLOWER].braking > found[Action.FASTER].braking


def test_both_stand_and_one_has_the_right_of_way(junction: Junction) -> None:
    cars = car("CAV1", "south-north", 88, 0, 0), car("HDV1", "east-west", 88, 0)
    [norm] = Briefing().outlook(junction.thoughts(*cars).safety_input("CAV1")).norms
    assert norm.startswith("you and HDV1 both stand: ")
    moving = junction.thoughts(cars[0], replace(cars[1], speed=5.0))
    assert Briefing().outlook(moving.safety_input("CAV1")).norms == ()
