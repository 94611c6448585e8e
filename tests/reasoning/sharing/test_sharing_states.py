"""What each CAV knows of the others, with and without state sharing."""

from dataclasses import replace

from worlds import Car, Junction, car

from codriving.datatypes.world import Kind
from codriving.reasoning.sharing.sharing import SensedStates, SharedStates

USUAL_LENGTH = 5.0

NOT_SENSED = {"kind", "heading", "acceleration", "lane"}


def cars() -> tuple[Car, ...]:
    return (
        car("CAV1", "south-north", 20.0, 7.0),
        car("CAV2", "north-south", 20.0, 8.0),
        car("HDV1", "north-south", 60.0, 6.0, pedal=-1.0),
        car("HDV2", "north-west", 90.0, 6.0),
    )


def test_all_cavs_are_shared_and_every_human_driver_near_any_of_them(junction: Junction) -> None:
    views = SharedStates().detections(junction.world(*cars()), junction.model)
    assert [g.id for g in views["CAV1"]] == ["CAV2", "HDV1"], "180 m away, but told by the other CAV"
    assert [g.id for g in views["CAV2"]] == ["CAV1", "HDV1"]


def test_shared_states_are_complete(junction: Junction) -> None:
    world = junction.world(*cars())
    seen = SharedStates().detections(world, junction.model)["CAV1"][1]
    state = next(v for v in world.vehicles if v.id == "HDV1")
    told = ("id", "kind", "x", "y", "speed", "heading", "acceleration", "lane", "length")
    assert {key: getattr(seen, key) for key in told} == {key: getattr(state, key) for key in told}


def test_sensed_states_are_position_and_speed_within_range(junction: Junction) -> None:
    world = junction.world(*cars())
    views = SensedStates().detections(world, junction.model)
    assert views["CAV1"] == ()
    (seen,) = views["CAV2"]
    state = next(v for v in world.vehicles if v.id == "HDV1")
    assert (seen.id, seen.x, seen.y, seen.speed) == ("HDV1", state.x, state.y, state.speed)
    assert all(getattr(seen, name) is None for name in NOT_SENSED)


def test_the_detection_range_is_a_circle_around_the_cav(junction: Junction) -> None:
    world = junction.world(car("CAV1", "south-north", 40.0, 7.0), car("HDV1", "south-north", 89.9, 7.0))
    for sharing in (SensedStates(), SharedStates()):
        assert len(sharing.detections(world, junction.model)["CAV1"]) == 1
        assert sharing.detections(world, replace(junction.model, detection_range=49.8))["CAV1"] == ()


def test_what_sensors_do_not_see_is_not_told(junction: Junction) -> None:
    world = junction.world(*cars())
    hidden = replace(
        world,
        vehicles=tuple(
            replace(v, heading=v.heading + 1.0, acceleration=3.0, lane=("il2", "o2", 0)) for v in world.vehicles
        ),
    )
    assert SensedStates().detections(world, junction.model) == SensedStates().detections(hidden, junction.model)


def test_the_length_of_a_vehicle_is_shared_but_not_sensed(junction: Junction) -> None:
    world = junction.world(*cars())
    longer = replace(world, vehicles=tuple(replace(v, length=12.0) for v in world.vehicles))
    assert {g.length for g in SharedStates().detections(longer, junction.model)["CAV2"]} == {12.0}
    assert {g.length for g in SensedStates().detections(longer, junction.model)["CAV2"]} == {USUAL_LENGTH}
    # As long as each vehicle is as long as is assumed, that changes nothing.
    assert {v.length for v in junction.environment.reset(0).vehicles} == {USUAL_LENGTH}


def test_watched_states_are_position_speed_and_heading_within_range(junction: Junction) -> None:
    world = junction.world(*cars())
    views = SensedStates(headings=True).detections(world, junction.model)
    assert views["CAV1"] == ()
    (seen,) = views["CAV2"]
    state = next(v for v in world.vehicles if v.id == "HDV1")
    told = {name for name in ("kind", "acceleration", "lane", "intent", "gap") if getattr(seen, name) is not None}
    assert not told
    assert (seen.x, seen.y, seen.speed, seen.heading) == (state.x, state.y, state.speed, state.heading)
    assert seen.length == USUAL_LENGTH


def test_watching_does_not_tell_who_drives(junction: Junction) -> None:
    world = junction.world(*cars())
    others = tuple(v if v.id == "CAV2" else replace(v, kind=Kind.HDV, acceleration=3.0) for v in world.vehicles)
    swapped = replace(world, vehicles=others)
    seen = [SensedStates(headings=True).detections(w, junction.model)["CAV2"] for w in (world, swapped)]
    assert seen[0] == seen[1]
