"""Who struck whom, in collisions made by hand."""

import math
from collections.abc import Callable
from itertools import combinations
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from codriving.datatypes.world import Kind, Start
from codriving.environment.collisions import find_collisions, responsibility
from codriving.environment.environment import Environment
from codriving.geometry.box import corners, overlap

EAST, SOUTH, WEST = 0.0, math.pi / 2, math.pi


def car(name: str, x: float, y: float, heading: float, speed: float) -> Any:
    return SimpleNamespace(id=name, position=np.array([x, y]), heading=heading, speed=speed, LENGTH=5.0, WIDTH=2.0)


CASES = {
    "rear-end": (car("A", 0.0, 0.0, EAST, 9.0), car("B", 4.6, 0.0, EAST, 3.0)),
    "rear-end on a standing car": (car("A", 0.0, 0.2, EAST, 4.0), car("B", 4.9, 0.0, EAST, 0.0)),
    "side impact": (car("A", 0.0, 0.0, EAST, 8.0), car("B", 3.3, 0.5, SOUTH, 5.0)),
    "slow side impact on a fast car": (car("A", 0.0, 0.0, EAST, 3.0), car("B", 3.4, -1.6, SOUTH, 9.0)),
    "side impact at the very corner": (car("A", 0.0, 0.0, EAST, 6.0), car("B", 3.3, 3.2, SOUTH, 6.0)),
    "head-on, the faster one": (car("A", 0.0, 0.0, EAST, 7.0), car("B", 4.7, 0.3, WEST, 2.0)),
    "reversing into a standing car": (car("A", 0.0, 0.0, EAST, -3.0), car("B", -4.8, 0.0, EAST, 0.0)),
    "turned into a standing car's nose": (car("A", 2.0, -3.3, SOUTH + 0.2, 5.0), car("B", 0.0, 0.0, EAST, 0.0)),
    "scraping along": (car("A", 0.0, 0.0, 0.15, 8.0), car("B", 1.0, 2.2, EAST, 8.0)),
}


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("case", CASES)
def test_striker_is_a(case: str, swapped: bool) -> None:
    one, other = CASES[case][::-1] if swapped else CASES[case]
    striker, struck = responsibility(one, other, 0.1)
    assert (striker.id, struck.id) == ("A", "B")


def test_cars_that_have_overlapped_all_the_time() -> None:
    one, other = car("A", 0.0, 0.0, EAST, 0.0), car("B", 1.0, 0.0, EAST, 0.0)
    assert {v.id for v in responsibility(one, other, 0.1)} == {"A", "B"}


def test_all_pairs_that_overlap_are_found_in_the_order_of_the_vehicles(by_hand: Callable[..., Environment]) -> None:
    starts = [Start(f"CAV{k}", Kind.CAV, "south-north", 10.0 * k, 5.0) for k in range(1, 9)]
    env, rng, hit = by_hand(starts=starts), np.random.default_rng(0), 0
    env.reset(0)
    vehicles = env._traffic.vehicles
    for _ in range(60):
        for vehicle in vehicles:
            vehicle.position[:], vehicle.heading = rng.uniform(-12, 12, 2), float(rng.uniform(-4, 4))
        boxes = [corners(*v.position, v.heading, v.LENGTH, v.WIDTH) for v in vehicles]
        pairs = [
            {one.id, other.id}
            for (one, box), (other, box2) in combinations(zip(vehicles, boxes, strict=True), 2)
            if overlap(box, box2)
        ]
        assert [{c.striker, c.struck} for _, c in find_collisions(vehicles, 0.0, 0.1, by_footprint=True)] == pairs
        hit += len(pairs)
    assert 100 < hit < 1000
