"""Which intents are known."""

from worlds import Junction, car

from codriving.reasoning.sharing.sharing import GUESSED_INTENTS, HIDDEN_INTENTS, SHARED_INTENTS


def test_cavs_tell_route_and_target_and_human_drivers_nothing(junction: Junction) -> None:
    world = junction.world(car("CAV1", "south-west", 40.0, 7.0, 9.0), car("HDV1", "west-east", 40.0, 7.0))
    told = SHARED_INTENTS.intents(world)
    assert set(told) == {"CAV1"}
    assert (told["CAV1"].route, told["CAV1"].target_speed) == ("south-west", 9.0)


def test_hidden_intents_leave_nothing_and_no_conflicts(junction: Junction) -> None:
    world = junction.world(car("CAV1", "south-west", 40.0, 7.0), car("CAV2", "west-east", 40.0, 7.0))
    assert dict(HIDDEN_INTENTS.intents(world)) == {}
    assert not HIDDEN_INTENTS.finds_conflicts
    assert SHARED_INTENTS.finds_conflicts


def test_a_vehicle_that_is_on_its_own_hears_nothing_and_still_finds_conflicts(junction: Junction) -> None:
    world = junction.world(car("CAV1", "south-west", 40.0, 7.0), car("CAV2", "west-east", 40.0, 7.0))
    assert dict(GUESSED_INTENTS.intents(world)) == {}
    assert GUESSED_INTENTS.finds_conflicts


def test_the_simulator_gives_away_no_human_intent(junction: Junction) -> None:
    world = junction.environment.reset(3)
    assert world.hdvs
    assert set(world.intents) == {cav.id for cav in world.cavs}
