"""Drives in the orders of the bound: they are driven, not below it, and near it."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from codriving.bound.measure import LoneRoad
from codriving.bound.meetings import Margins
from codriving.bound.witness import _touch, witness
from codriving.bound.world import BoundedWorld, bounded_world
from codriving.datatypes import Action, Ending


@pytest.mark.parametrize("scenario", ["intersection", "roundabout"])
def test_witness_is_driven_without_touching_and_near_the_bound(
    world: Callable[..., BoundedWorld], scenario: str
) -> None:
    at = world(f"scenario={scenario}")
    gaps = []
    for seed in (23_500, 23_501):
        bound = at.solve(seed)
        found = witness(at, seed, bound)
        assert found is not None
        gaps.append((found.total - bound.total) / bound.cavs)
        road, starts = LoneRoad(at.environment), [cav.start for cav in at.cavs(seed)]
        outcome = road.together(starts, found.plans)
        assert outcome is not None
        assert outcome.ending is Ending.SUCCESS
        assert sum(outcome.arrivals.values()) == pytest.approx(found.total)
    assert min(gaps) >= -1e-9
    assert max(gaps) < 0.5


def test_touching_is_seen_between_two_steps(world: Callable[..., BoundedWorld]) -> None:
    at = world("scenario=intersection")
    road = LoneRoad(at.environment)
    cav = at.cavs(23_500)[0].start
    drive = road.drive(cav, lambda _: Action.FASTER)
    assert _touch(drive, drive)
    assert not _touch(drive, replace(drive, corners=drive.corners + 50.0))
    # One that stands where the other one is in the middle of a step, and is away from it at both ends.
    jump = replace(drive, corners=drive.corners[:2] + np.array([[[[0.0, 0.0]]], [[[30.0, 0.0]]]])[:, 0])
    stands = replace(drive, corners=np.repeat(drive.corners[:1] + np.array([12.0, 0.0]), 2, axis=0))
    assert _touch(jump, stands)


def test_bound_with_margins_has_a_timetable_that_arrives_as_it_says(world: Callable[..., BoundedWorld]) -> None:
    at = bounded_world(world("scenario=intersection").environment, margins=Margins())
    bound = at.solve(23_500)
    ends = [max(times[1, -1], cav.arrival) for times, cav in zip(bound.times, at.cavs(23_500), strict=True)]
    assert bound.total - 0.1 <= sum(ends) <= bound.total + 0.1
    assert all(np.all(np.diff(times[1]) >= 0) for times in bound.times)
