"""What a CAV remembers of its neighbours."""

from dataclasses import replace

import pytest
from worlds import Junction, car

from codriving.datatypes.situation import TrackedVehicle
from codriving.datatypes.world import Intent, Kind, Told
from codriving.reasoning.sharing.sharing import SensedStates, SharedStates
from codriving.reasoning.sharing.tracking import Tracking


def perceived(junction: Junction, route: str, place: float, speed: float = 6.0, full: bool = True) -> TrackedVehicle:
    """What CAV1 is told of a human driver, or senses itself."""
    human = car("HDV1", route, place, speed)
    path = junction.road_map.paths[route]
    watcher = car("CAV1", route, max(place - 20.0, 0.0), 6.0)
    assert path.length > place
    sharing = SharedStates() if full else SensedStates()
    (seen,) = sharing.detections(junction.world(watcher, human), junction.model)["CAV1"]
    return seen


def routes(tracking: Tracking, seen: TrackedVehicle, ego: str = "CAV1") -> set[str]:
    tracking.begin_step()
    return {route for route, _ in tracking.places(ego, seen, None)}


@pytest.mark.parametrize("route", ["south-west", "south-north", "south-east", "east-south"])
def test_possible_routes_narrow_as_a_driver_turns(route: str, junction: Junction) -> None:
    tracking = Tracking(junction.road_map)
    source = route.split("-")[0]
    before = routes(tracking, perceived(junction, route, 60.0))
    assert before == {name for name in junction.road_map.routes if name.startswith(source)}
    for place in range(62, 122, 3):
        now = routes(tracking, perceived(junction, route, float(place)))
        assert route in now, "the true route is never ruled out"
        assert now <= before, "what has been ruled out stays out"
        before = now
    assert before == {route}


@pytest.mark.parametrize("route", ["south-west", "south-north", "south-east"])
@pytest.mark.parametrize("wrong", [(3.0, 3.0), (3.0, -3.0), (-3.0, 3.0), (-3.0, -3.0)])
def test_noise_of_messages_rules_no_true_route_out(junction: Junction, route: str, wrong: tuple[float, float]) -> None:
    """A place that is 4.2 m off may lie beside every route, on another one, or where a turn has not begun."""
    tracking = Tracking(junction.road_map)
    for place in range(60, 123, 3):
        seen = perceived(junction, route, float(place))
        assert seen.heading is not None
        at = (seen.x + wrong[0], seen.y + wrong[1])
        told = Told(0.1, None, aside=3.0 * 2**0.5, since=(*at, seen.heading))
        assert route in routes(tracking, replace(seen, x=at[0], y=at[1], told=told))


def test_noise_of_messages_may_put_a_vehicle_on_the_lane_beside(merge: Junction) -> None:
    for route in merge.road_map.routes:
        seen = perceived(merge, route, 100.0)
        for wrong in (-3.0, 3.0):
            off = replace(seen, y=seen.y + wrong)
            assert seen.heading is not None
            told = Told(0.1, None, aside=3.0, since=(off.x, off.y, seen.heading))
            assert route in routes(Tracking(merge.road_map), replace(off, told=told))


def test_routes_are_remembered_past_the_junction(junction: Junction) -> None:
    tracking, fresh = Tracking(junction.road_map), Tracking(junction.road_map)
    for place in (60.0, 100.0, 110.0, 118.0, 150.0):
        after = routes(tracking, perceived(junction, "south-north", place))
    assert after == {"south-north"}
    assert len(routes(fresh, perceived(junction, "south-north", 150.0))) > 1


def test_each_cav_watches_for_itself(junction: Junction) -> None:
    tracking = Tracking(junction.road_map)
    for place in (60.0, 118.0):
        routes(tracking, perceived(junction, "south-north", place))
    late = perceived(junction, "south-north", 150.0)
    assert routes(tracking, late, "CAV1") < routes(tracking, late, "CAV2")


def test_arc_lengths_are_those_of_the_vehicle(junction: Junction) -> None:
    tracking = Tracking(junction.road_map)
    for route, place in tracking.places("CAV1", perceived(junction, "south-west", 60.0), None):
        assert place == pytest.approx(60.0, abs=0.1), route


def test_without_headings_more_routes_are_possible(junction: Junction) -> None:
    full = routes(Tracking(junction.road_map), perceived(junction, "south-north", 109.0))
    sensed = routes(Tracking(junction.road_map), perceived(junction, "south-north", 109.0, full=False))
    assert full < sensed


def test_a_shared_route_is_believed(junction: Junction) -> None:
    intent = Intent("south-west", 6.0, ("o0", "ir0", 0))
    ((route, place),) = Tracking(junction.road_map).places("CAV1", perceived(junction, "south-north", 60.0), intent)
    assert route == "south-west"
    assert place == pytest.approx(60.0, abs=0.1)


def test_a_body_between_two_lanes_is_on_both_whether_it_shares_or_not(highway: Junction) -> None:
    world = highway.world(car("CAV1", "lane-2", 280.0, 20.0), car("CAV2", "lane-0", 300.0, 20.0, offset=1.5))
    (full,) = SharedStates().detections(world, highway.model)["CAV1"]
    (sensed,) = SensedStates().detections(world, highway.model)["CAV1"]
    on_both = (("lane-0", pytest.approx(300.0)), ("lane-1", pytest.approx(300.0)))
    assert Tracking(highway.road_map).places("CAV1", full, world.intents["CAV2"]) == on_both
    assert Tracking(highway.road_map).places("CAV1", sensed, None) == on_both


def test_who_is_still_on_the_ramp_lane_beside_its_taper_is_on_the_ramp(merge: Junction) -> None:
    taper = merge.road_map.changes.ahead("ramp", 0.0)
    assert taper is not None
    _, latest, end = taper
    for place in (latest - 30.0, latest, end - 5.0):
        # The route bends towards the main road there; the driver has stayed on the centre line of the ramp lane.
        x, y = place - merge.road_map.lane_start("ramp", ("b", "c", 2)) + 230.0, 8.0
        seen = TrackedVehicle("HDV1", Kind.HDV, x, y, 10.0, 0.0, 0.0, ("b", "c", 2), 5.0)
        found = dict(Tracking(merge.road_map).places("CAV1", seen, None))
        assert found["ramp"] == pytest.approx(place, abs=1.0)
        assert "main-0" not in found


def test_standing_is_timed_and_forgotten_when_it_moves(junction: Junction) -> None:
    tracking = Tracking(junction.road_map)
    stands, moves = perceived(junction, "west-east", 80.0, 0.0), perceived(junction, "west-east", 80.0, 3.0)
    assert tracking.standing("CAV1", moves, 0.0) == 0
    assert tracking.standing("CAV1", stands, 1.0) == 0
    assert tracking.standing("CAV1", stands, 2.5) == pytest.approx(1.5)
    assert tracking.standing("CAV2", stands, 2.5) == 0
    assert tracking.standing("CAV1", moves, 3.0) == 0
    assert tracking.standing("CAV1", stands, 4.0) == 0


@pytest.mark.parametrize(
    ("route", "place", "full", "possible"),
    [
        # Half a metre beside a route or 0.15 rad (9 degrees) off it is one step of misfit; two steps more than the best
        # route rule a route out.
        ("south-east", 101.2, True, {"south-east", "south-north", "south-west"}),
        ("south-east", 101.4, True, {"south-east", "south-north"}),
        ("south-east", 102.0, True, {"south-east", "south-north"}),
        ("south-east", 102.2, True, {"south-east"}),
        ("south-north", 102.0, True, {"south-east", "south-north", "south-west"}),
        ("south-north", 102.2, True, {"south-north", "south-west"}),
        ("south-north", 102.6, True, {"south-north", "south-west"}),
        ("south-north", 102.8, True, {"south-north"}),
        # Without the heading the place alone tells, later.
        ("south-east", 103.2, False, {"south-east", "south-north", "south-west"}),
        ("south-east", 103.4, False, {"south-east", "south-north"}),
        ("south-east", 104.2, False, {"south-east", "south-north"}),
        ("south-east", 104.4, False, {"south-east"}),
    ],
)
def test_where_routes_part_the_others_are_ruled_out_at_two_steps_of_misfit(
    route: str, place: float, full: bool, possible: set[str], junction: Junction
) -> None:
    assert routes(Tracking(junction.road_map), perceived(junction, route, place, full=full)) == possible


@pytest.mark.parametrize("signal", ["left", "right"])
def test_a_turn_signal_narrows_the_possible_routes_and_is_remembered(signal: str, junction: Junction) -> None:
    tracking = Tracking(junction.road_map)
    told = {"left": ("south-west",), "right": ("south-east",)}[signal]
    near, far = perceived(junction, told[0], 85.0), perceived(junction, told[0], 60.0)
    assert len(tracking.places("CAV1", far, None, signal)) == 3, "no route is signalled so early; it is not believed"
    assert tuple(route for route, _ in tracking.places("CAV1", near, None, signal)) == told
    assert tuple(route for route, _ in tracking.places("CAV1", near, None)) == told
    # Without a signal all stay possible: not every driver signals.
    assert len(Tracking(junction.road_map).places("CAV1", near, None)) == 3
