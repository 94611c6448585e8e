"""Buildings at the corners of the intersection, 8 m beside the middles of its roads, and who sees whom past them.

The junction begins 11 m from the middle: a vehicle at s on its leg of 100 m is 111 - s before the middle. Between one
from the south at (2, 32) and one from the east at (32, -2) the line is at y = 25.2 where the building begins, at x = 8,
and so in it. With the first at (2, 10) it is at y = 7.6, and passes it.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.parts import Drivers, Scenario
from codriving.datatypes.world import Action, Kind, Start, WorldState
from codriving.environment.drivers.style import DriverMix
from codriving.environment.environment import Environment
from codriving.environment.traffic.human_driver import HumanDriver
from codriving.reasoning.sharing.sharing import SensedStates, SharedStates

Drive = Callable[..., Environment]


def blind(near: float | None = 8.0) -> Scenario:
    return build({**compose(["scenario=intersection"])["scenario"], "blind": near}, Scenario)


def starts(south: float) -> list[Start]:
    return [
        Start("CAV1", Kind.CAV, "south-north", south, 8.0),
        Start("CAV2", Kind.CAV, "north-south", 20.0, 8.0),
        Start("HDV1", Kind.HDV, "east-west", 79.0, 8.0),
    ]


@pytest.fixture
def reset(by_hand: Drive) -> Callable[[float], WorldState]:
    return lambda south: by_hand(starts=starts(south), road=blind().road).reset(0)


def test_who_is_behind_a_corner_is_hidden(reset: Callable[[float], WorldState]) -> None:
    assert reset(79.0).hidden == (("CAV1", "HDV1"), ("CAV2", "HDV1"))
    assert reset(99.0).hidden == (("CAV1", "HDV1"), ("CAV2", "HDV1")), "at (2, 12), at y = 9.2 at the corner"
    assert reset(101.0).hidden == (("CAV2", "HDV1"),)


def test_sensors_do_not_see_what_is_hidden_and_others_tell(
    reset: Callable[[float], WorldState], by_hand: Drive
) -> None:
    model = replace(by_hand(starts=starts(79.0)).driving_model, detection_range=200.0)

    def known(world: WorldState, sharing: SharedStates | SensedStates) -> dict[str, list[str]]:
        found = sharing.detections(world, model)
        return {name: [vehicle.id for vehicle in others] for name, others in found.items()}

    far, near = reset(79.0), reset(101.0)
    assert known(far, SensedStates()) == {"CAV1": ["CAV2"], "CAV2": ["CAV1"]}
    assert known(far, SharedStates()) == {"CAV1": ["CAV2"], "CAV2": ["CAV1"]}
    assert known(near, SensedStates()) == {"CAV1": ["CAV2", "HDV1"], "CAV2": ["CAV1"]}
    assert known(near, SharedStates()) == {"CAV1": ["CAV2", "HDV1"], "CAV2": ["CAV1", "HDV1"]}, "CAV1 tells"


def test_cavs_behind_corners_tell_each_other_of_themselves(by_hand: Drive) -> None:
    two = [Start("CAV1", Kind.CAV, "south-north", 79.0, 8.0), Start("CAV2", Kind.CAV, "east-west", 79.0, 8.0)]
    env = by_hand(starts=two, road=blind().road)
    world = env.reset(0)
    assert world.hidden == (("CAV1", "CAV2"),)
    assert SensedStates().detections(world, env.driving_model) == {"CAV1": (), "CAV2": ()}
    assert [v.id for v in SharedStates().detections(world, env.driving_model)["CAV1"]] == ["CAV2"]


def people(by_hand: Drive, drivers: str) -> dict[str, Any]:
    """Drivers of a group; those with a style look and react without delay."""
    if drivers == "simulator":
        return {}
    node = compose([f"drivers={drivers}"])["drivers"]
    node["styles"]["attentive"] |= {"reaction": [0.0, 0.0], "speed": [1.0, 1.0]}
    mix = build(node, Drivers)
    assert isinstance(mix, DriverMix)
    return {"people": mix}


@pytest.mark.parametrize("drivers", ["simulator", "attentive"])
@pytest.mark.parametrize(("near", "waits"), [(None, True), (8.0, False)])
def test_a_human_driver_waits_only_for_whom_it_sees(
    by_hand: Drive, drivers: str, near: float | None, waits: bool
) -> None:
    """HDV1 comes from the south and would be met in the junction by CAV1 from the west, which has the right of way."""
    two = [Start("HDV1", Kind.HDV, "south-north", 85.0, 8.0), Start("CAV1", Kind.CAV, "west-east", 84.0, 8.0)]
    env = by_hand(starts=two, road=blind(near).road, **people(by_hand, drivers))
    world = env.reset(0)
    assert bool(world.hidden) is not waits
    env.step({"CAV1": Action.IDLE})
    (driver,) = (vehicle for vehicle in env._traffic.vehicles if isinstance(vehicle, HumanDriver))
    assert (driver.waits_at is not None) is waits


@pytest.mark.parametrize("drivers", ["simulator", "attentive"])
@pytest.mark.parametrize(("near", "sees"), [(None, True), (8.0, False)])
def test_a_human_driver_does_not_brake_for_what_stands_round_the_corner(
    by_hand: Drive, drivers: str, near: float | None, sees: bool
) -> None:
    """From the south to the east, where a CAV stands 20 m past the junction, at (31, 2)."""
    two = [Start("HDV1", Kind.HDV, "south-east", 75.0, 8.0), Start("CAV1", Kind.CAV, "west-east", 142.0, 0.0)]
    env = by_hand(starts=two, road=blind(near).road, **people(by_hand, drivers))
    env.reset(0)
    assert bool(env._world.hidden) is not sees
    env.step({"CAV1": Action.SLOWER})
    (driver,) = (vehicle for vehicle in env._traffic.vehicles if isinstance(vehicle, HumanDriver))
    assert (driver.action["acceleration"] < -0.2) is sees


def test_what_is_seen_a_reaction_time_ago_is_what_was_in_sight_then(by_hand: Drive) -> None:
    node = compose(["drivers=attentive"])["drivers"]
    node["styles"]["attentive"] |= {"reaction": [1.0, 1.0], "speed": [1.0, 1.0]}
    mix = build(node, Drivers)
    two = [Start("HDV1", Kind.HDV, "south-north", 90.0, 8.0), Start("CAV1", Kind.CAV, "west-east", 79.0, 8.0)]
    env = by_hand(starts=two, road=blind().road, people=mix)
    world, since = env.reset(0), []
    while len(since) < 2:
        world = env.step({"CAV1": Action.IDLE})
        driver, cav = env._traffic.vehicles
        told = cav in [thing for thing, *_ in env._traffic.seen_by(driver, 1.0)]
        if not world.hidden and not since:
            since.append(world.time)
            assert not told
        elif since and told:
            since.append(world.time)
    assert since[1] - since[0] == pytest.approx(1.0, abs=0.5)
