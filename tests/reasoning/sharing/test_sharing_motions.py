"""Vehicles as things that move along routes."""

from worlds import Junction, car

from codriving.reasoning.sharing.sharing import SensedStates


def test_a_vehicle_is_on_every_lane_that_its_body_reaches_onto(highway: Junction) -> None:
    thoughts = highway.thoughts(
        car("CAV1", "lane-0", 300.0, 20.0, 25.0, offset=2.5),
        car("CAV2", "lane-3", 320.0, 18.0, 15.0, offset=-1.0),
        car("HDV1", "lane-2", 340.0, 16.0),
    )
    found = thoughts.scenes["CAV1"].vehicles()
    assert list(found) == ["CAV1", "CAV2", "HDV1"]
    assert {name: [route for route, _ in m.routes] for name, m in found.items()} == {
        "CAV1": ["lane-0", "lane-1"],
        "CAV2": ["lane-3", "lane-2"],
        "HDV1": ["lane-2"],
    }
    assert [m.is_cav for m in found.values()] == [True, True, False]
    assert [m.target for m in found.values()] == [25.0, 15.0, 16.0]


def test_a_vehicle_that_shares_no_intent_is_no_cav_and_keeps_its_speed(highway: Junction) -> None:
    world = highway.world(car("CAV1", "lane-0", 300.0, 20.0), car("HDV1", "lane-0", 340.0, 16.0, pedal=-2.0))
    human = highway.think(world, SensedStates()).scenes["CAV1"].vehicles()["HDV1"]
    assert (human.is_cav, human.target, human.acceleration) == (False, 16.0, None)
