"""One number for what a vehicle means to do, on junctions and on lanes."""

from codriving.datatypes.road import LaneId, Route, Turn
from codriving.datatypes.world import Intent
from codriving.gym.observation import Intention, intention

RAMP: tuple[LaneId, ...] = (("j", "b", 0), ("b", "c", 2), ("b", "c", 1), ("c", "d", 1))
ROUTES = {
    "left": Route("left", (("a", "b", 0),), Turn.LEFT, 50.0, 100.0),
    "right": Route("right", (("a", "b", 0),), Turn.RIGHT, 50.0, 100.0),
    "lane": Route("lane", (("a", "b", 1),), Turn.STRAIGHT, 50.0, 100.0),
    "ramp": Route("ramp", RAMP, Turn.STRAIGHT, 50.0, 100.0),
}


def of(route: str, lane: LaneId | None, target: LaneId) -> Intention:
    return intention(Intent(route, 9.0, target), lane, ROUTES)


def test_nothing_is_known_without_an_intent() -> None:
    assert intention(None, ("a", "b", 0), ROUTES) == Intention.HIDDEN == 0


def test_at_a_junction_it_is_the_turn_of_the_route() -> None:
    assert of("left", ("a", "b", 0), ("a", "b", 0)) == Intention.LEFT
    assert of("right", ("a", "b", 0), ("b", "c", 3)) == Intention.RIGHT, "the next lane is not one beside it"


def test_a_lane_change_under_way_comes_first() -> None:
    assert of("lane", ("a", "b", 1), ("a", "b", 1)) == Intention.STRAIGHT
    assert of("lane", ("a", "b", 1), ("a", "b", 0)) == Intention.LEFT
    assert of("lane", ("a", "b", 1), ("a", "b", 2)) == Intention.RIGHT
    assert of("right", ("a", "b", 1), ("a", "b", 0)) == Intention.LEFT


def test_a_route_that_changes_lanes_shows_it_until_it_is_done() -> None:
    assert [of("ramp", lane, lane) for lane in RAMP] == [
        Intention.LEFT,
        Intention.LEFT,
        Intention.STRAIGHT,
        Intention.STRAIGHT,
    ]
    assert of("ramp", ("b", "c", 0), ("b", "c", 0)) == Intention.STRAIGHT


def test_a_lane_that_is_hidden_leaves_the_route() -> None:
    assert of("ramp", None, ("b", "c", 2)) == Intention.LEFT
    assert of("left", None, ("b", "c", 2)) == Intention.LEFT
