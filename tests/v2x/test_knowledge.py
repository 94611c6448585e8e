"""What one CAV knows: its own sensors first, messages for the rest, and what is old brought up to the present."""

from collections.abc import Callable
from math import pi, sqrt

import pytest
from hearing import Radio, channel_settings
from worlds import Junction, car

from codriving.datatypes.parts import Shares
from codriving.datatypes.world import Kind, Told, VehicleState, WorldState
from codriving.environment.environment import Environment

EGO = car("CAV1", "south-north", 30.0, 8.0)
FAR = car("CAV2", "south-north", 115.0, 6.0, 9.0)
NEAR = car("CAV3", "south-north", 60.0, 5.0)
HIDDEN = (("CAV1", "CAV3"),)


def vehicle(world: WorldState, name: str) -> VehicleState:
    """One vehicle of a world."""
    return next(v for v in world.vehicles if v.id == name)


def test_what_is_exact_and_new_is_known_as_it_is(junction: Junction) -> None:
    radio = Radio(junction)
    world = radio.send(1.0, EGO, FAR, NEAR)
    known = radio.look(1.0, EGO, FAR, NEAR)
    assert (known.vehicles, known.intents, known.available) == (world.vehicles, world.intents, world.available)
    assert (known.time, known.step, known.viewer, known.deciding) == (1.0, 0, "CAV1", ("CAV1",))
    assert known.told == {"CAV2": Told(0.0, 0.0), "CAV3": Told(0.0, 0.0, seen=True)}


def test_own_sensors_replace_messages(junction: Junction) -> None:
    radio = Radio(junction, channel_settings(age=0.5, noise=1.0))
    radio.send(0.0, EGO, NEAR)
    braked = car("CAV3", "south-north", 61.0, 1.0)
    known = radio.look(0.5, EGO, braked)
    assert vehicle(known, "CAV3") == radio.junction.state(braked)
    # The intent is that of the message.
    assert known.told["CAV3"] == Told(0.0, 0.5, seen=True)
    assert known.intents["CAV3"].target_speed == 5.0


def test_what_a_building_hides_is_known_by_messages(junction: Junction) -> None:
    radio = Radio(junction, channel_settings(age=0.5))
    radio.send(0.0, EGO, NEAR)
    known = radio.look(0.5, EGO, car("CAV3", "south-north", 61.0, 1.0), hidden=HIDDEN)
    there = vehicle(known, "CAV3")
    assert junction.road_map.project("south-north", there.x, there.y)[0] == pytest.approx(62.5, abs=0.01)
    assert (there.speed, known.told["CAV3"].age, known.told["CAV3"].seen) == (5.0, 0.5, False)
    assert known.hidden == HIDDEN


def test_a_vehicle_whose_intent_is_known_goes_on_along_its_route(junction: Junction) -> None:
    road_map = junction.road_map
    turning = car("CAV2", "south-west", road_map.routes["south-west"].entry, 6.0)
    radio = Radio(junction, channel_settings(age=2.0))
    radio.send(0.0, EGO, turning)
    told = vehicle(radio.look(2.0, EGO, turning, hidden=(("CAV1", "CAV2"),)), "CAV2")
    place, lateral = road_map.project("south-west", told.x, told.y)
    assert place == pytest.approx(turning.place + 12.0, abs=0.05)
    assert abs(lateral) < 0.01
    assert told.heading == pytest.approx(float(road_map.paths["south-west"].heading(place)), abs=0.01)
    assert told.lane == road_map.lane_at("south-west", place)


def test_one_whose_intent_is_not_known_goes_straight_on_and_may_have_taken_any_way(junction: Junction) -> None:
    road_map = junction.road_map
    human = car("HDV1", "south-west", road_map.routes["south-west"].entry, 6.0)
    by = car("CAV2", "south-north", human.place + 30.0, 6.0)
    hidden = (("CAV1", "HDV1"),)
    radio = Radio(junction, channel_settings(age=2.0))
    world = radio.send(0.0, EGO, by, human, hidden=hidden)
    known = radio.look(2.0, EGO, by, human, hidden=hidden)
    before, told = vehicle(world, "HDV1"), vehicle(known, "HDV1")
    assert (told.x - before.x, told.y - before.y) == pytest.approx((0.0, -12.0), abs=0.05)
    assert told.heading == before.heading == pytest.approx(-pi / 2, abs=0.01)
    assert known.told["HDV1"].since == (before.x, before.y, before.heading)
    (seen,) = (n for n in junction.think(known).scenes["CAV1"].neighbours if n.id == "HDV1")
    ways = dict(seen.routes)
    assert {"south-north", "south-west", "south-east"} <= set(ways)
    assert ways["south-west"] == pytest.approx(human.place + 12.0, abs=0.05)


def test_a_cav_without_a_known_intent_counts_as_a_human_driver(junction: Junction) -> None:
    radio = Radio(junction, shares=Shares(states=True))
    radio.send(0.0, EGO, FAR, NEAR)
    known = radio.look(0.0, EGO, FAR, NEAR)
    assert {v.id: v.kind for v in known.vehicles} == {"CAV1": Kind.CAV, "CAV2": Kind.HDV, "CAV3": Kind.HDV}
    assert known.intents.keys() == known.available.keys() == {"CAV1"}


def test_what_has_not_been_heard_of_and_is_not_seen_is_not_there(junction: Junction) -> None:
    radio = Radio(junction, channel_settings(age=1.0))
    radio.send(0.0, EGO, FAR, NEAR)
    assert [v.id for v in radio.look(0.5, EGO, FAR, NEAR).vehicles] == ["CAV1", "CAV3"]
    assert [v.id for v in radio.look(1.0, EGO, FAR, NEAR).vehicles] == ["CAV1", "CAV2", "CAV3"]
    # Without a new message it is forgotten 3 s after it was sent.
    assert [v.id for v in radio.look(3.0, EGO, FAR, NEAR).vehicles] == ["CAV1", "CAV2", "CAV3"]
    forgotten = radio.look(3.1, EGO, FAR, NEAR)
    assert {v.id: v.kind for v in forgotten.vehicles} == {"CAV1": Kind.CAV, "CAV3": Kind.HDV}


@pytest.mark.parametrize(("gap", "there"), [(30.0, False), (45.0, True), (60.0, True)])
def test_a_vehicle_is_forgotten_where_sensors_see_that_it_is_not_there(
    junction: Junction, gap: float, there: bool
) -> None:
    # Sensors see 50 m; 0.5 s later a vehicle may be more than 5 m from where it is taken to be.
    radio = Radio(junction, channel_settings(age=0.5), shares=Shares(states=True))
    radio.send(0.0, EGO, car("CAV2", "south-north", EGO.place + gap, 2.0))
    # Something between hides it.
    behind = radio.look(0.5, EGO, hidden=(("CAV1", "CAV2"),))
    assert [v.id for v in behind.vehicles] == ["CAV1", "CAV2"]
    known = radio.look(0.5, EGO)
    assert [v.id for v in known.vehicles] == ["CAV1", "CAV2"][: 1 + there]
    assert set(known.told) == {"CAV2"} if there else not known.told


@pytest.mark.parametrize(("blind", "there"), [("null", False), ("8", True)])
def test_a_place_behind_a_building_is_not_seen_to_be_empty(
    blind: str, there: bool, configured: Callable[..., Environment]
) -> None:
    corner = Junction(configured("scenario=intersection", f"scenario.blind={blind}"))
    radio = Radio(corner, shares=Shares(states=True))
    near = car("CAV1", "south-north", 85.0, 5.0)
    radio.send(0.0, near, car("CAV2", "west-east", 85.0, 5.0))
    assert [v.id for v in radio.look(0.0, near).vehicles] == ["CAV1", "CAV2"][: 1 + there]


def test_a_vehicle_that_has_passed_its_goal_since_has_left(junction: Junction) -> None:
    goal = junction.road_map.routes["south-north"].goal
    for place, there in ((goal - 6.1, True), (goal - 5.9, False)):
        radio = Radio(junction, channel_settings(age=1.0))
        leaving = car("CAV2", "south-north", place, 6.0)
        radio.send(0.0, EGO, leaving)
        known = radio.look(1.0, EGO)
        assert (any(v.id == "CAV2" for v in known.vehicles), "CAV2" in known.told, "CAV2" in known.intents) == (
            (there,) * 3
        )


def test_of_several_that_tell_of_one_vehicle_the_newest_counts(junction: Junction) -> None:
    by, other = car("CAV2", "south-north", 120.0, 0.0), car("CAV3", "south-north", 170.0, 0.0)
    radio = Radio(junction, channel_settings(age=0.0))
    radio.send(0.0, EGO, by, car("HDV1", "south-north", 145.0, 2.0))
    radio.look(0.0, EGO)
    # Now only CAV3 sees it.
    hidden = (("CAV2", "HDV1"),)
    radio.send(0.5, EGO, by, other, car("HDV1", "south-north", 149.0, 3.0), hidden=hidden)
    known = radio.look(0.5, EGO, by, other, car("HDV1", "south-north", 149.0, 3.0), hidden=hidden)
    assert (vehicle(known, "HDV1").speed, known.told["HDV1"].age) == (3.0, 0.0)


def test_its_own_image_in_messages_is_nothing_new(junction: Junction) -> None:
    radio = Radio(junction, channel_settings(noise=3.0))
    radio.send(0.0, EGO, NEAR)
    known = radio.look(0.0, EGO, NEAR)
    assert vehicle(known, "CAV1") == junction.state(EGO)
    assert "CAV1" not in known.told


def test_a_turn_signal_is_told_with_a_vehicle_that_is_seen(junction: Junction) -> None:
    radio = Radio(junction)
    by, human = car("CAV2", "south-north", 150.0, 0.0), car("HDV1", "south-north", 130.0, 2.0)
    world = radio.world(0.0, EGO, by, human)
    signalling = WorldState(
        0.0, 0, world.vehicles, world.intents, world.available, {"HDV1": "left"}, (("CAV1", "HDV1"),)
    )
    radio.channel.hear(signalling)
    radio.known.hear(radio.channel.received("CAV1", 0.0), 0.0)
    assert radio.known.of(signalling).signals == {"HDV1": "left"}


@pytest.mark.parametrize("kind", ["CAV2", "HDV2"])
def test_bounds_say_what_can_have_happened_since(junction: Junction, kind: str) -> None:
    by = car("CAV3", "south-north", 100.0, 6.0)
    there = car(kind, "south-north", 120.0, 6.0)
    radio = Radio(junction, channel_settings(age=1.0, noise=0.1, speed_noise=0.05))
    radio.send(0.0, EGO, by, there)
    told = radio.look(1.0, EGO, by, there).told[kind]
    # Without limits a CAV changes its speed by up to 9 m/s times the gain of 1 / 0.6 s; a human driver brakes by 6 m/s2
    # and pulls away with 3 m/s2 at most.
    place, speed = 0.3 * sqrt(2), 0.15
    heard = vehicle(radio.look(1.0, EGO, by, there), kind).speed
    if kind == "CAV2":
        pedal = brake = junction.model.speed_gain * 9.0
    else:
        pedal, brake = 3.0, 6.0
    stops = heard**2 / (2 * brake) if heard / brake < 1 else heard - brake / 2
    assert (told.age, told.aside) == (1.0, pytest.approx(place))
    assert told.ahead >= pedal / 2 + speed + place
    assert told.behind >= heard - stops + speed + place
    # No wider than half as much again.
    assert told.ahead <= 1.5 * (pedal / 2 + speed + place)
    assert told.behind <= 1.5 * (heard - stops + speed + place)
    assert told.slower == pytest.approx(min(heard, brake) + speed)
    assert told.faster == pytest.approx(pedal + speed)
