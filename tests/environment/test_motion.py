"""How vehicles steer and move together is how each does alone."""

from collections.abc import Callable
from copy import deepcopy

import numpy as np
import pytest

from codriving.datatypes.world import Kind, Start
from codriving.environment.environment import Environment
from codriving.environment.motion import clip, face, move, steer

Build = Callable[..., Environment]


@pytest.mark.parametrize("name", ["sin", "cos", "tan", "arctan", "arcsin"])
def test_numpy_gives_a_number_the_same_bits_alone_and_among_others(name: str) -> None:
    function, rng = getattr(np, name), np.random.default_rng(0)
    for count in range(1, 20):
        for _ in range(20):
            numbers = rng.uniform(-1, 1, count) * (1 if name == "arcsin" else rng.choice([0.01, 1.0, 7.0, 30.0]))
            assert function(numbers).tolist() == [float(function(number)) for number in numbers.tolist()]


def test_vehicles_move_together_as_each_does_alone(intersection: Build) -> None:
    env = intersection()
    env.reset(3)
    together = env._traffic.vehicles
    rng = np.random.default_rng(1)
    for _ in range(20):
        for vehicle in together:
            vehicle.action = {"steering": float(rng.normal()) * 0.2, "acceleration": float(rng.normal())}
        alone = deepcopy(together)
        move(together, 0.1)
        for vehicle in alone:
            move([vehicle], 0.1)
        face(together)
        for one, other in zip(together, alone, strict=True):
            assert one.position.tolist() == other.position.tolist()
            assert (one.heading, one.speed, one.s, one.lane_index) == (
                other.heading,
                other.speed,
                other.s,
                other.lane_index,
            )
            assert one.facing() == (float(np.cos(other.heading)), float(np.sin(other.heading)))


def test_vehicles_steer_together_as_each_does_alone(intersection: Build) -> None:
    env = intersection()
    env.reset(3)
    vehicles = env._traffic.vehicles
    alone = [vehicle.keep_lane() for vehicle in deepcopy(vehicles)]
    steer(vehicles)
    assert all(vehicle.steers is not None for vehicle in vehicles)
    assert [vehicle.keep_lane() for vehicle in vehicles] == alone
    assert all(vehicle.steers is None for vehicle in vehicles)


def test_who_comes_to_the_end_of_a_lane_steers_for_the_next_one(by_hand: Build) -> None:
    env = by_hand(starts=[Start("CAV1", Kind.CAV, "south-north", 98.6, 5.0)])
    env.reset(0)
    (cav,) = env._traffic.vehicles
    before = cav.target_lane_index
    steer([cav])
    assert cav.steers is None
    cav.keep_lane()
    assert cav.target_lane_index != before


def test_numbers_are_kept_between_two_bounds() -> None:
    assert [clip(value, 2.0) for value in (-3.0, -2.0, 0.5, 2.0, 3.0)] == [-2.0, -2.0, 0.5, 2.0, 2.0]
