"""Whom a learned driver knows of."""

from dataclasses import replace

import pytest
from worlds import Junction, car

from codriving.methods.learned.known import Knowledge


@pytest.mark.parametrize(("shared", "known"), [(False, ["CAV3"]), (True, ["CAV2", "CAV3", "HDV1"])])
def test_what_a_building_hides_is_known_only_if_others_tell(junction: Junction, shared: bool, known: list[str]) -> None:
    cars = (
        car("CAV1", "south-north", 80.0, 8.0),
        car("CAV2", "west-east", 80.0, 8.0),
        car("CAV3", "north-south", 80.0, 8.0),
        car("HDV1", "west-east", 65.0, 8.0),
    )
    world = replace(junction.world(*cars), hidden=(("CAV1", "CAV2"), ("CAV1", "HDV1")))
    others = Knowledge(junction.road_map, 70.0, shared, routes=True).others(world)
    assert [other.id for other in others["CAV1"]] == known
    unseen = replace(world, hidden=(*world.hidden, ("CAV2", "HDV1"), ("CAV3", "HDV1")))
    assert "HDV1" not in [other.id for other in Knowledge(junction.road_map, 70.0, shared, True).others(unseen)["CAV1"]]
