"""The search finds drives that are as early as any, keep clear of what is blocked, and are those of the environment."""

from collections.abc import Callable
from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from codriving.bound.measure import LoneRoad
from codriving.datatypes import Action, Kind, Start
from codriving.environment.environment import Environment
from codriving.geometry.search import Search

FAR = np.full(400, np.inf)


@pytest.fixture(scope="module")
def search(configured: Callable[..., Environment]) -> Search:
    """A left turn of the default world, 60 m before its goal of 145.4 m, at 7 m/s."""
    environment = configured("scenario=intersection", "suite=default")
    profile = environment.road_map.speed_profiles(environment.driving_model)["south-west"]
    return Search(environment.driving_model, 70.0, 7.0, 6.0, 110.0, profile=profile)


def test_nothing_in_the_way_is_driven_faster_for_ever(search: Search) -> None:
    found = search.drive(400)
    assert found is not None
    assert set(found.plan) == {Action.FASTER}
    assert found.arrives == search.driven((Action.FASTER,), 100).arrives
    assert found.places[found.arrives] >= 110.0 > found.places[found.arrives - 1]


def test_no_plan_of_five_decisions_gets_farther_past_a_wall(search: Search) -> None:
    wall = np.where(np.arange(400) < 20, 80.0, np.inf)
    blocked = replace(search, low=(wall,), high=(FAR,), merged=(0.02, 0.02))
    best = -np.inf
    for plan in product((Action.FASTER, Action.IDLE, Action.HOLD, Action.SLOWER), repeat=5):
        driven = search.driven(plan)
        if np.all(driven.places <= wall[: len(driven.places)]):
            best = max(best, float(driven.places[-1]))
    found = blocked.drive(25)
    assert found is not None
    assert found.arrives is None
    assert found.places[-1] == pytest.approx(best, abs=0.15)
    assert found.places[-1] <= best + 1e-9
    assert np.all(found.places[:20] <= 80.0)


def test_stretch_that_moves_is_let_pass_or_left_behind(search: Search) -> None:
    steps = np.arange(400)
    # A body of 12 m that comes from behind, at 11 m/s, and one of 10 m that goes ahead at 4 m/s until step 60.
    behind = 40.0 + 1.1 * steps
    ahead = np.where(steps < 60, 85.0 + 0.4 * steps, np.inf)
    asked = replace(search, low=(behind - 6.0, ahead), high=(behind + 6.0, np.where(steps < 60, ahead + 10, np.inf)))
    found = asked.drive(400)
    assert found is None or not _within(found.places, behind - 6.0, behind + 6.0)
    asked = replace(search, low=(ahead,), high=(np.where(steps < 60, ahead + 10, np.inf),))
    found = asked.drive(400)
    assert found is not None
    assert found.arrives is not None
    assert not _within(found.places, ahead, ahead + 10)


def _within(places: np.ndarray, low: np.ndarray, high: np.ndarray) -> bool:
    n = len(places)
    return bool(np.any((places > low[:n]) & (places < high[:n])))


def test_what_stands_at_the_end_stands_for_ever(search: Search) -> None:
    # Past the four steps that are given the wall stays, 8 m ahead.
    found = replace(search, speed=3.0, target=3.0, low=(np.full(4, 78.0),), high=(np.full(4, np.inf),)).drive(60)
    assert found is not None
    assert found.arrives is None
    assert 76.0 < found.places[-1] <= 78.0


def test_who_cannot_keep_clear_finds_nothing(search: Search) -> None:
    assert replace(search, low=(np.full(400, 72.0),), high=(FAR,)).drive(400) is None


@pytest.mark.parametrize("suite", ["default", "paper"])
def test_its_drives_are_those_of_the_environment(configured: Callable[..., Environment], suite: str) -> None:
    environment = configured("scenario=intersection", f"suite={suite}")
    road = LoneRoad(environment)
    model, start = road.model, Start("CAV1", Kind.CAV, "south-north", 60.0, 5.5)
    profile = environment.road_map.speed_profiles(model).get("south-north")
    plan = (Action.FASTER, Action.SLOWER, Action.HOLD, Action.IDLE, Action.SLOWER, Action.FASTER, Action.HOLD)
    found = Search(model, 60.0, 5.5, 6.0, 150.0, profile=profile).driven(plan)
    drive = road.drive(start, lambda step: plan[min(step, len(plan) - 1)])
    assert np.abs(found.places - drive.places[: len(found.places)]).max() < 1e-6
