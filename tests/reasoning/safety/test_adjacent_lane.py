"""Second layer: lane changes, on a straight road with two lanes made by hand."""

from dataclasses import replace

import pytest
from worlds import Junction, car

from codriving.datatypes.action import Action
from codriving.datatypes.road import Lane, LaneId, Road, Route, Straight, Turn
from codriving.datatypes.scene_description import Neighbour
from codriving.geometry.road_map import RoadMap
from codriving.reasoning.safety.adjacent_lane import check_adjacent
from codriving.reasoning.safety.assessment import ThreeLayers
from codriving.reasoning.safety.outlook import Outlook
from codriving.reasoning.state_sharing import SensedStates

LEFT: LaneId = ("a", "b", 0)
RIGHT: LaneId = ("a", "b", 1)
ACTIONS = (Action.SLOWER, Action.IDLE, Action.FASTER, Action.LANE_LEFT)


@pytest.fixture(scope="module")
def highway(junction: Junction) -> Junction:
    """Two lanes beside each other; the left one is lane 0."""
    lanes = tuple(Lane(name, Straight((0.0, 4.0 * name[2]), (400.0, 4.0 * name[2]))) for name in (LEFT, RIGHT))
    routes = tuple(Route(name, (lane,), Turn.STRAIGHT, 0.0, 380.0) for name, lane in (("left", LEFT), ("right", RIGHT)))
    made = Junction(junction.environment)
    made.road_map = RoadMap(Road("two lanes", lanes, routes))
    return made


def beside(highway: Junction, place: float, speed: float, lane: str = "left", ego: float = 8.0) -> Outlook:
    """CAV1 on the right lane at 100 m, and HDV1 somewhere."""
    thoughts = highway.thoughts(car("CAV1", "right", 100.0, ego), car("HDV1", lane, place, speed))
    return thoughts.outlook("CAV1", actions=ACTIONS)


def test_the_lane_to_the_left_is_adjacent(highway: Junction) -> None:
    assert beside(highway, 60.0, 8.0).scene.adjacent_lanes == (LEFT,)


def test_a_vehicle_beside_removes_the_lane_change_and_nothing_else(highway: Junction) -> None:
    outlook = beside(highway, 102.0, 8.0)
    found = check_adjacent(outlook)
    assert set(found) == {Action.LANE_LEFT}
    (reason,) = found[Action.LANE_LEFT]
    assert reason.startswith("adjacent lane: HDV1")
    allowed = {a.action for a in ThreeLayers().assess(outlook) if a.safe}
    assert allowed == set(ACTIONS) - {Action.LANE_LEFT}


def test_a_free_gap_stays_allowed(highway: Junction) -> None:
    for place in (60.0, 140.0):
        outlook = beside(highway, place, 8.0)
        assert check_adjacent(outlook) == {}
        assert Action.LANE_LEFT in {a.action for a in ThreeLayers().assess(outlook) if a.safe}


def test_somebody_fast_from_behind_needs_more_room_than_somebody_slow(highway: Junction) -> None:
    def nearest(speed: float) -> float:
        return max(s for s in range(55, 100) if check_adjacent(beside(highway, float(s), speed, ego=4.0)) == {})

    assert nearest(9.0) < nearest(4.0)


def test_the_one_ahead_on_the_own_lane_does_not_hinder_a_change(highway: Junction) -> None:
    assert check_adjacent(beside(highway, 106.0, 8.0, lane="right")) == {}


def test_a_road_without_that_lane_has_nothing_to_check(highway: Junction) -> None:
    outlook = highway.thoughts(car("CAV1", "right", 100.0, 8.0), car("HDV1", "left", 101.0, 8.0)).outlook("CAV1")
    assert check_adjacent(outlook) == {}


def test_the_right_lane_is_checked_as_well(highway: Junction) -> None:
    thoughts = highway.thoughts(car("CAV1", "left", 100.0, 8.0), car("HDV1", "right", 103.0, 8.0))
    outlook = thoughts.outlook("CAV1", actions=(Action.IDLE, Action.LANE_RIGHT))
    assert set(check_adjacent(outlook)) == {Action.LANE_RIGHT}


def test_a_vehicle_whose_lane_is_not_known_counts(highway: Junction) -> None:
    world = highway.world(car("CAV1", "right", 100.0, 8.0), car("HDV1", "left", 101.0, 8.0))
    outlook = highway.think(world, SensedStates()).outlook("CAV1", actions=ACTIONS)
    (n,) = outlook.scene.neighbours
    assert isinstance(n, Neighbour)
    assert n.lane is None
    assert Action.LANE_LEFT in check_adjacent(outlook)
    gone = replace(outlook, scene=replace(outlook.scene, neighbours=()))
    assert check_adjacent(gone) == {}
