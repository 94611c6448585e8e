"""What a vehicle on its own sees does not depend on what others are, mean or do."""

from collections.abc import Callable

import numpy as np
import pytest
from driven import drive, ordered
from hidden import scrambled
from worlds import Junction, car

from codriving.environment.environment import Environment
from codriving.reasoning.perception import Moment, single_vehicle_perception

SCENARIOS = ("intersection", "roundabout", "highway", "merge")


def told(perceived: Moment, ego: str) -> tuple[object, ...]:
    return perceived.scenes[ego], perceived.conflicts[ego], perceived.vehicles[ego]


@pytest.mark.parametrize("scenario", SCENARIOS)
def test_nothing_hidden_is_seen(scenario: str, configured: Callable[..., Environment]) -> None:
    junction = Junction(configured(f"scenario={scenario}"))
    rng = np.random.default_rng(0)
    worlds = drive(junction.environment, ordered(junction), 10_003, decisions=16).worlds
    ego = worlds[0].cavs[0].id
    one, other = (single_vehicle_perception(junction.road_map, junction.forecast()) for _ in range(2))
    for world in worlds:
        if ego in world.intents:
            hidden = scrambled(world, ego, junction.road_map, rng)
            assert hidden != world
            assert told(one.perceive(world), ego) == told(other.perceive(hidden), ego)


def test_conflicts_are_found_with_every_way_that_is_possible_and_fewer_once_it_shows(junction: Junction) -> None:
    perception = single_vehicle_perception(junction.road_map, junction.forecast())
    ego = car("CAV1", "south-north", 85.0, 7.0, 9.0)
    early = perception.perceive(junction.world(ego, car("CAV2", "west-east", 85.0, 7.0, 9.0)))
    (seen,) = early.scenes["CAV1"].neighbours
    assert (seen.kind, seen.intent) == (None, None)
    assert {route for route, _ in seen.routes} == {"west-east", "west-north", "west-south"}
    assert len({c.routes[1] for c in early.conflicts["CAV1"]}) > 1
    assert not any(c.certain for c in early.conflicts["CAV1"])
    assert not early.vehicles["CAV1"]["CAV2"].is_cav
    late = perception.perceive(junction.world(ego, car("CAV2", "west-south", 112.0, 7.0, 9.0)))
    (seen,) = late.scenes["CAV1"].neighbours
    assert [route for route, _ in seen.routes] == ["west-south"]
    again = perception.perceive(junction.world(ego, car("CAV2", "west-east", 100.0, 7.0, 9.0)))
    (seen,) = again.scenes["CAV1"].neighbours
    assert [route for route, _ in seen.routes] == ["west-south"], "what has been seen is not forgotten"
