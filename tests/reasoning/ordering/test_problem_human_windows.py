"""When human drivers may use a zone, and who is in the way."""

import math
from dataclasses import replace

import pytest
from worlds import Junction, Thoughts, car

from codriving.reasoning.ordering.problem import GAP, is_blocked, lag_length, passes_first, window

CERTAIN_GAP = 0.4


def meeting(junction: Junction, place: float, speed: float, cav: float = 85.0) -> Thoughts:
    """A CAV from the south, without the right of way, and a human driver from the west."""
    return junction.thoughts(car("CAV1", "south-north", cav, 8.0), car("HDV1", "west-east", place, speed))


def first_window(thoughts: Thoughts) -> tuple[float, float]:
    c = next(c for c in thoughts.conflicts["CAV1"] if c.routes[1] == "west-east")
    n = thoughts.scenes["CAV1"].neighbours[0]
    zone = thoughts.junction.road_map.zones(*c.routes)[c.zone]
    return window(thoughts.moment(), c, n, zone.entry_i)


def test_a_window_is_an_interval_around_the_passage(junction: Junction) -> None:
    begin, end = first_window(meeting(junction, 80.0, 8.0))
    assert begin < end < math.inf
    at_present_speed = (108.4 - 80.0) / 8.0
    assert begin < at_present_speed < end


def test_the_farther_the_driver_the_later_the_window(junction: Junction) -> None:
    windows = [first_window(meeting(junction, place, 8.0)) for place in (70.0, 78.0, 86.0, 94.0)]
    begins, ends = zip(*windows, strict=True)
    assert list(begins) == sorted(begins, reverse=True)
    assert list(ends) == sorted(ends, reverse=True)


def test_a_driver_who_gives_way_blocks_nothing(junction: Junction) -> None:
    thoughts = meeting(junction, 90.0, 0.0)
    n = replace(thoughts.scenes["CAV1"].neighbours[0], standing=60.0)
    for c in thoughts.conflicts["CAV1"]:
        assert window(thoughts.moment(), c, n, 100.0) == (math.inf, math.inf)


@pytest.mark.parametrize(("human", "first"), [(65.0, True), (95.0, False)])
def test_a_cav_passes_first_only_if_it_is_through_in_time(human: float, first: bool, junction: Junction) -> None:
    thoughts = meeting(junction, human, 6.0, cav=98.0)
    scene = thoughts.scenes["CAV1"]
    conflicts = thoughts.conflicts["CAV1"]
    assert passes_first(thoughts.moment(), "CAV1", scene.neighbours[0], conflicts) is first


def test_blocked_by_a_body_in_the_way_only(junction: Junction) -> None:
    for place, blocks in ((80.0, False), (104.0, False), (113.0, True), (125.0, False)):
        conflicts = meeting(junction, place, 0.0).conflicts["CAV1"]
        straight = [c for c in conflicts if c.routes[1] == "west-east"]
        assert any(is_blocked(c, junction.road_map) for c in straight) is blocks, place


def test_who_has_passed_is_not_blocked(junction: Junction) -> None:
    (c,) = junction.thoughts(car("CAV1", "south-north", 113.0, 5.0), car("CAV2", "west-east", 111.0, 5.0)).conflicts[
        "CAV1"
    ]
    assert not is_blocked(replace(c, places=(116.0, 111.0)), junction.road_map)


def test_a_window_is_when_a_driver_is_likely_there_not_when_it_might_be_at_the_worst(junction: Junction) -> None:
    thoughts = meeting(junction, 70.0, 8.0)
    begin, end = first_window(thoughts)
    c = next(c for c in thoughts.conflicts["CAV1"] if c.routes[1] == "west-east")
    zone = junction.road_map.zones(*c.routes)[c.zone]
    reach = thoughts.forecast.reach(8.0, False)
    earliest = thoughts.forecast.time_to(c.distances[1], reach.most)
    steady = thoughts.forecast.time_to(c.distances[1], reach.steady)
    # The CAV has to be out of the way before; at its top speed that takes this long.
    through = (zone.entry_j + lag_length(zone) - zone.entry_i) / 9.0
    assert earliest < begin + through + CERTAIN_GAP < steady
    gone = thoughts.forecast.time_to(zone.entry_i + lag_length(zone, False) - c.places[1], reach.steady)
    assert gone + GAP < end < gone + GAP + 2.0


def test_a_driver_who_has_to_change_onto_the_own_lane_blocks_nothing(merge: Junction) -> None:
    thoughts = merge.thoughts(car("CAV1", "main-1", 215.0, 15.0), car("HDV1", "ramp", 225.0, 15.0))
    (c,) = thoughts.conflicts["CAV1"]
    n = thoughts.scenes["CAV1"].neighbours[0]
    assert window(thoughts.moment(), c, n, 240.0) == (math.inf, math.inf)
