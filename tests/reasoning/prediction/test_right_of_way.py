"""Which human drivers can be relied on to give way, and why."""

from dataclasses import replace

import pytest
from worlds import Car, Junction, car

from codriving.datatypes.world import Manner
from codriving.geometry.road_map import RoadMap, road_map
from codriving.reasoning.prediction.right_of_way import gives_way, known_to_give_way

PLACES = [60.0 + 0.5 * k for k in range(80)]


def reason(
    junction: Junction,
    cav: Car,
    human: Car,
    standing: float = 0.0,
    pedal: float | None = 0.0,
    road: RoadMap | None = None,
    manner: Manner | None = None,
) -> str:
    """What is said of a human driver on exactly the route that it drives; empty if it is not relied on."""
    # Far from one another no vehicle is perceived: a second CAV beside the driver tells of it.
    witness = car("CAV2", human.route, max(human.place - 20.0, 0.0), 0.0)
    thoughts = junction.thoughts(cav, witness, human)
    mover = replace(thoughts.scenes["CAV1"].vehicles()["HDV1"], standing=standing, acceleration=pedal)
    reasons = {
        gives_way(c, mover, road or junction.road_map)
        if manner is None
        else known_to_give_way(c, mover, road or junction.road_map, manner)
        for c in thoughts.conflicts["CAV1"]
        if c.other == "HDV1" and c.routes[1] == human.route
    }
    (said,) = reasons
    return said


def test_who_has_been_standing_gives_way(junction: Junction) -> None:
    pair = car("CAV1", "south-north", 80.0, 8.0), car("HDV1", "west-east", 96.0, 0.1)
    assert "standing" in reason(junction, *pair, standing=30.0)
    assert not reason(junction, *pair, standing=0.0)


def test_who_is_in_the_zone_does_not(junction: Junction) -> None:
    assert not reason(junction, car("CAV1", "east-west", 80.0, 8.0), car("HDV1", "south-north", 112.0, 3.0))


def test_the_lower_priority_gives_way_while_it_can_still_wait(junction: Junction) -> None:
    major = car("CAV1", "east-west", 80.0, 8.0)
    assert "right of way" in reason(junction, major, car("HDV1", "south-north", 60.0, 8.0))
    assert not reason(junction, major, car("HDV1", "south-north", 94.0, 8.0))


def test_the_higher_priority_does_not_give_way(junction: Junction) -> None:
    minor = car("CAV1", "south-north", 80.0, 8.0)
    assert not reason(junction, minor, car("HDV1", "west-east", 60.0, 8.0))
    # South and north rank the same.
    assert not reason(junction, minor, car("HDV1", "north-east", 60.0, 8.0))


def test_without_a_right_of_way_on_the_road_none_is_relied_on(junction: Junction) -> None:
    free = road_map(replace(junction.road_map.road, regulated=False))
    major = car("CAV1", "east-west", 80.0, 8.0)
    assert not reason(junction, major, car("HDV1", "south-north", 60.0, 8.0), road=free)


def test_a_cav_in_the_junction_is_waited_for(junction: Junction) -> None:
    inside = car("CAV1", "south-west", 102.0, 5.0)
    assert "already" in reason(junction, inside, car("HDV1", "east-west", 60.0, 8.0))
    assert not reason(junction, inside, car("HDV1", "east-west", 95.0, 8.0))


def test_a_cav_in_the_zone_is_waited_for_by_drivers_who_can_stop_before_it(junction: Junction) -> None:
    inside = car("CAV1", "south-north", 108.0, 5.0)
    assert "already" in reason(junction, inside, car("HDV1", "west-east", 70.0, 8.0))
    assert not reason(junction, inside, car("HDV1", "west-east", 106.0, 8.0))


@pytest.mark.parametrize("speed", [6.0, 9.0])
def test_a_driver_who_brakes_is_relied_on_for_longer(speed: float, junction: Junction) -> None:
    def relied_on(pedal: float | None) -> set[float]:
        major = car("CAV1", "east-west", 80.0, 8.0)
        return {
            s for s in PLACES if s < 100 and reason(junction, major, car("HDV1", "south-north", s, speed), 0.0, pedal)
        }

    braking, coasting, unknown = relied_on(-5.5), relied_on(0.0), relied_on(None)
    assert coasting == unknown
    assert coasting < braking
    assert coasting == {s for s in PLACES if s <= max(coasting)}, "nearer never means surer"


def test_the_faster_the_driver_the_earlier_it_is_not_relied_on(junction: Junction) -> None:
    def latest(speed: float) -> float:
        major = car("CAV1", "east-west", 80.0, 8.0)
        return max(s for s in PLACES if s < 100 and reason(junction, major, car("HDV1", "south-north", s, speed)))

    assert latest(9.0) < latest(6.0) < latest(3.0) + 1


def test_who_has_to_leave_a_lane_that_ends_gives_way_while_it_can_stop(merge: Junction) -> None:
    assert not merge.road_map.road.regulated
    main = car("CAV1", "main-1", 230.0, 15.0)
    for place, relied_on in ((235.0, True), (270.0, True), (309.0, False)):
        assert bool(reason(merge, main, car("HDV1", "ramp", place, 15.0))) is relied_on
    assert "change onto the CAV's lane" in reason(merge, main, car("HDV1", "ramp", 235.0, 15.0))
    # The slower the driver, the later it can still stop.
    assert reason(merge, main, car("HDV1", "ramp", 309.0, 5.0))


def test_no_vehicle_gives_way_to_who_has_to_leave_the_lane_itself(merge: Junction) -> None:
    assert not reason(merge, car("CAV1", "ramp", 235.0, 15.0), car("HDV1", "main-1", 230.0, 15.0))


RULE, HIGHER, NEVER = (Manner(name, False, 0.8) for name in ("by_rule", "to_higher_rank", "never"))
HESITANT, LATE = Manner("by_rule", True, 0.8), Manner("by_rule", False, 0.8, 1.2)

# The CAV, the human driver, and the styles of those that give way to it. East and west rank above south and north;
# the junction begins 100 m down each leg.
KNOWN = [
    ("east-west 80 8", "south-north 60 8", "rule higher hesitant late"),
    ("east-west 80 8", "south-north 80 8", "rule higher hesitant"),  # Who sees it late brakes too late
    ("east-west 80 8", "south-north 90 8", ""),  # None of them can stop any more before it has noticed
    ("south-north 80 8", "west-east 60 8", "hesitant"),  # It has the right of way
    ("south-north 80 8", "north-east 60 8", "hesitant"),  # Of equal rank
    ("south-north 104 3", "west-east 60 8", "rule higher hesitant late"),  # The CAV is in the junction already
    ("south-north 111 3", "west-east 80 8", "rule higher hesitant late never"),  # In the zone: bodies are minded by all
    ("east-west 80 8", "south-north 96 0.1", "rule higher hesitant late"),  # It stands
    ("south-north 80 8", "west-east 96 0.1", "hesitant"),  # It stands, but has the right of way
    ("east-west 80 8", "south-north 102 0.1", ""),  # It stands in the junction, and wants to leave it
]


@pytest.mark.parametrize(("cav", "human", "styles"), KNOWN)
def test_of_whom_it_is_known_how_it_treats_the_right_of_way(
    cav: str, human: str, styles: str, junction: Junction
) -> None:
    def at(name: str, text: str) -> Car:
        route, place, speed = text.split()
        return car(name, route, float(place), float(speed))

    manners = {"rule": RULE, "higher": HIGHER, "hesitant": HESITANT, "late": LATE, "never": NEVER}
    told = {n: reason(junction, at("CAV1", cav), at("HDV1", human), 30.0, manner=m) for n, m in manners.items()}
    assert " ".join(name for name, why in told.items() if why) == styles


def test_a_driver_who_is_seen_to_brake_has_noticed(junction: Junction) -> None:
    pair = car("CAV1", "east-west", 80.0, 8.0), car("HDV1", "south-north", 88.0, 8.0)
    assert not reason(junction, *pair, pedal=0.0, manner=LATE)
    assert reason(junction, *pair, pedal=-2.0, manner=LATE)
    assert not reason(junction, *pair, pedal=-2.0, manner=NEVER)
