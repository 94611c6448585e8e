"""Facts of highway-env that are kept, because planning has to know them."""

from collections.abc import Callable
from dataclasses import fields

import numpy as np
import pytest

from codriving.datatypes.world import Action, Kind, Start
from codriving.environment.cav import ConnectedVehicle
from codriving.environment.environment import Environment
from codriving.environment.settings import Corrections
from codriving.geometry.box import PLANNING, TRUE, corners

Build = Callable[..., Environment]


@pytest.mark.usefixtures("clean_class")
@pytest.mark.parametrize("off", [(), tuple(field.name for field in fields(Corrections))], ids=["corrected", "stock"])
def test_cavs_are_never_regulated(off: tuple[str, ...], by_hand: Build) -> None:
    # The driver comes from the road with the right of way; nothing makes the CAV wait but its own decisions.
    starts = [Start("CAV1", Kind.CAV, "south-north", 70.0, 9.0), Start("HDV1", Kind.HDV, "west-east", 50.0, 6.0)]
    env = by_hand(*off, starts=starts)
    world = env.reset(0)
    for _ in range(6):
        world = env.step({"CAV1": Action.IDLE})
        assert world.intents["CAV1"].target_speed == 9.0
        assert world.cavs[0].speed == pytest.approx(9.0)
    assert world.cavs[0].y < 20.0


@pytest.mark.parametrize(
    ("speed", "action", "target"),
    [
        (4.4, Action.FASTER, 6.0),  # nearest to 3, so one step up is 6, whatever the target was
        (4.6, Action.FASTER, 9.0),
        (4.6, Action.SLOWER, 3.0),
        (7.6, Action.SLOWER, 6.0),
        (7.4, Action.SLOWER, 3.0),
        (0.0, Action.SLOWER, 0.0),
        (9.0, Action.FASTER, 9.0),
        (12.0, Action.SLOWER, 6.0),
    ],
)
def test_target_steps_from_the_present_speed(speed: float, action: Action, target: float, by_hand: Build) -> None:
    env = by_hand(starts=[Start("CAV1", Kind.CAV, "south-north", 30.0, 9.0)])
    env.reset(0)
    vehicle = env._traffic.vehicles[0]
    assert isinstance(vehicle, ConnectedVehicle)
    vehicle.speed = speed
    vehicle.act(action)
    assert vehicle.target_speed == target


def test_target_speeds_are_taken_as_evenly_spaced(by_hand: Build) -> None:
    env = by_hand(starts=[Start("CAV1", Kind.CAV, "south-north", 30.0, 9.0)])
    env.reset(0)
    vehicle = env._traffic.vehicles[0]
    vehicle.target_speeds = np.array([0.0, 1.0, 2.0, 9.0])
    assert vehicle.speed_to_index(2.0) == 1, "nearest is number 2, but number 1 of four even steps from 0 to 9 is at 3"


def test_there_is_no_comfort_bound(by_hand: Build) -> None:
    env = by_hand(starts=[Start("CAV1", Kind.CAV, "south-north", 30.0, 1.0)], target_speeds=(0.0, 9.0))
    env.reset(0)
    world = env.step({"CAV1": Action.FASTER})
    hardest = max(env.trajectory().tracks[0].acceleration)
    assert hardest == pytest.approx(1.6 * 8.0)
    assert world.cavs[0].speed > 5.0


@pytest.mark.parametrize("speed", [3.0, 6.0, 9.0])
def test_how_far_corners_are_cut(speed: float, intersection: Build, by_hand: Build) -> None:
    cut, out = 0.0, 0.0
    for route in intersection().scenario.road.routes:
        env = by_hand(starts=[Start("CAV1", Kind.CAV, route.id, 80.0, speed)])
        world = env.reset(0)
        while env.outcome is None:
            world = env.step({cav.id: Action.IDLE for cav in world.cavs})
        track = env.trajectory().tracks[0]
        path = env.road_map.paths[route.id]
        for x, y, heading in zip(track.x, track.y, track.heading, strict=True):
            s, lateral = path.project(x, y)
            cut = max(cut, abs(lateral))
            px, py = path.position(s)
            aim = float(path.heading(s))
            car = corners(x, y, heading, TRUE.length, TRUE.width) - (float(px), float(py))
            along = car @ (np.cos(aim), np.sin(aim))
            across = car @ (-np.sin(aim), np.cos(aim))
            assert np.abs(along).max() <= PLANNING.length / 2
            out = max(out, np.abs(across).max() - PLANNING.width / 2)
    assert 0.3 < cut <= 0.8
    # Turned inwards as well, the car leaves the planning footprint with one corner.
    assert 0.3 < out <= 0.7
