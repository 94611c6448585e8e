"""The demonstrated rule: FASTER, then IDLE, then SLOWER, and the first that keeps clear of each vehicle."""

import pytest
from dilu_driven import rule
from worlds import Car, Junction, car

from codriving.datatypes.world import Action
from codriving.errors import ConfigError
from codriving.methods.single_vehicle.demonstrated import CONSTANT, LIMITS
from codriving.methods.single_vehicle.method import Choice
from codriving.reasoning.perception import Moment, single_vehicle_perception
from codriving.reasoning.prediction.forecast import Forecast


def view(world: Junction, *cars: Car) -> tuple[Moment, str]:
    """What CAV1 sees."""
    perception = single_vehicle_perception(world.road_map, Forecast(world.model, CONSTANT))
    return perception.perceive(world.world(*cars)), "CAV1"


def decide(world: Junction, *cars: Car, **change: float) -> Choice:
    """What the rule says, as it is configured but for what is named."""
    return rule(**change).decide(*view(world, *cars))


def test_alone_it_accelerates(junction: Junction) -> None:
    for speed in (0.0, 4.0, 9.0):
        choice = decide(junction, car("CAV1", "south-north", 60, speed))
        assert (choice.action, choice.refused) == (Action.FASTER, {})


def test_first_action_that_keeps_the_headway_is_taken(junction: Junction) -> None:
    ego = car("CAV1", "south-north", 40, 6, 6)
    found = [decide(junction, ego, car("HDV1", "south-north", 45 + gap, 6)).action for gap in (25, 13, 7)]
    assert found == [Action.FASTER, Action.IDLE, Action.SLOWER]
    assert decide(junction, ego, car("HDV1", "south-north", 66, 6), headway=0.5).action is Action.FASTER


def test_who_gets_away_is_not_too_close(junction: Junction) -> None:
    ego = car("CAV1", "south-north", 40, 3, 3)
    assert decide(junction, ego, car("HDV1", "south-north", 48, 9)).action is not Action.SLOWER
    assert decide(junction, ego, car("HDV1", "south-north", 48, 1)).action is Action.SLOWER


def test_zone_is_left_to_the_first_there(junction: Junction) -> None:
    ego = car("CAV1", "south-north", 84, 9, 9)
    late = decide(junction, ego, car("HDV1", "west-east", 88, 9))
    assert late.action is Action.SLOWER
    assert late.refused[Action.IDLE] == "HDV1 may be there first"
    assert [(p.first, p.second) for p in late.precedences] == [("HDV1", "CAV1")]
    early = decide(junction, ego, car("HDV1", "west-east", 74, 5))
    assert early.action is Action.FASTER
    assert [(p.first, p.second) for p in early.precedences] == [("CAV1", "HDV1")]


def test_what_is_beyond_the_horizon_does_not_matter_yet(junction: Junction) -> None:
    ego, other = car("CAV1", "south-north", 78, 9, 9), car("HDV1", "west-east", 88, 9)
    assert decide(junction, ego, other).action is Action.SLOWER
    assert decide(junction, ego, other, horizon=1.0).action is Action.FASTER


def test_it_slows_down_and_says_so_if_nothing_is_acceptable(junction: Junction) -> None:
    choice = decide(junction, car("CAV1", "south-north", 40, 9, 9), car("HDV1", "south-north", 50, 0))
    assert choice.action is Action.SLOWER
    assert choice.reason == "nothing is acceptable, so SLOWER: HDV1 ahead is close"
    assert set(choice.refused) == {Action.FASTER, Action.IDLE}


def test_lanes_are_changed_where_that_pays_and_the_headway_holds(highway: Junction) -> None:
    ego, slow = car("CAV1", "lane-1", 100, 25, 25), car("HDV1", "lane-1", 150, 19)
    changes = {Action.LANE_LEFT, Action.LANE_RIGHT}
    assert decide(highway, ego, slow).action in changes
    beside = [car("HDV2", "lane-0", 140, 24), car("HDV3", "lane-2", 140, 24)]
    choice = decide(highway, ego, slow, *beside)
    assert choice.action not in changes
    assert {choice.refused[a] for a in changes} == {"HDV2 ahead there is close", "HDV3 ahead there is close"}
    assert decide(highway, ego, slow, *beside, headway=0.5).action in changes


@pytest.mark.parametrize("key", LIMITS)
def test_setting_out_of_range_is_refused(key: str) -> None:
    low, high = LIMITS[key]
    for value in (low - 1, high + 1):
        with pytest.raises(ConfigError, match=f"{key} must be"):
            rule(**{key: value})
