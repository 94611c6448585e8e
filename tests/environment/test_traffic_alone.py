"""Human drivers among themselves: all get through, none backs up, none hits another, on every road."""

from collections.abc import Callable
from dataclasses import dataclass

import pytest

from codriving.datatypes.record import Collision
from codriving.environment.environment import Environment
from codriving.environment.termination import Termination
from codriving.environment.traffic.human_driver import HumanDriver

Build = Callable[..., Environment]

DENSE = {
    "intersection": ["scenario.hdvs=[8,8]"],
    "roundabout": ["scenario.hdvs=[8,8]"],
    "highway": ["scenario.hdvs=[14,14]"],
    "merge": ["scenario.hdvs=[8,8]", "scenario.ramp_hdvs=0.5", "scenario.lanes=1"],
}
# Before drivers reckoned with speeding up themselves, and left a time gap on the main road, they crashed in these.
SEEDS = {
    "intersection": (10003, 10010, 10020, 10028, 10032, 10041),
    "roundabout": (10000, 10001, 10002, 10003),
    "highway": (10000, 10001, 10002, 10003),
    "merge": (10015, 10028, 10031, 10033, 10037),
}


@dataclass
class Drive:
    """What happened while only human drivers were on the road."""

    left: list[str]
    slowest: float
    collisions: list[Collision]
    time: float


def alone(env: Environment, seed: int, limit: float = 90.0) -> Drive:
    """Take the CAVs off the road and let the others drive."""
    env.reset(seed)
    traffic, dt = env._traffic, env.driving_model.step
    traffic.vehicles = [vehicle for vehicle in traffic.vehicles if isinstance(vehicle, HumanDriver)]
    judge, slowest, time = Termination(["nobody"], 10 * limit, dt), 0.0, 0.0
    while traffic.vehicles and time < limit:
        traffic.act()
        traffic.step(dt)
        time += dt
        slowest = min([slowest, *(vehicle.speed for vehicle in traffic.vehicles)])
        judge.check(traffic, time)
    return Drive([vehicle.id for vehicle in traffic.vehicles], slowest, judge._bystanders, time)


@pytest.mark.parametrize("name", DENSE)
def test_all_get_through_without_a_scratch(name: str, configured: Build) -> None:
    env = configured(f"scenario={name}", "scenario.cavs=2", *DENSE[name])
    for seed in SEEDS[name]:
        drive = alone(env, seed)
        assert drive.collisions == [], seed
        assert drive.left == [], f"{drive.left} still stand there (seed {seed})"
        assert drive.slowest >= 0.0


def test_no_floor_at_zero_speed_lets_them_back_up_on_any_road(configured: Build) -> None:
    off = "environment.corrections.no_reverse=false"
    env = configured("scenario=merge", "scenario.cavs=2", *DENSE["merge"], off)
    assert min(alone(env, seed, 30.0).slowest for seed in range(10000, 10006)) < 0.0
