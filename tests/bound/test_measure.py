"""The envelope that is shipped holds for drives that it was not measured with; and how one is measured."""

import itertools
from collections.abc import Callable

import numpy as np
import pytest

from codriving.bound.envelope import text_of
from codriving.bound.measure import LoneRoad, measure, random_actions, random_start
from codriving.bound.world import BoundedWorld
from codriving.datatypes import Action


@pytest.mark.parametrize("suite", ["default", "paper"])
@pytest.mark.parametrize("scenario", ["intersection", "roundabout"])
def test_random_drives_stay_inside(world: Callable[..., BoundedWorld], scenario: str, suite: str) -> None:
    at = world(f"scenario={scenario}", f"suite={suite}")
    road, rng = LoneRoad(at.environment), np.random.default_rng(23_000)
    routes = sorted(at.environment.road_map.routes)
    assert at.envelopes is not None
    for k in range(15):
        route = routes[int(rng.integers(len(routes)))]
        start = random_start(road, route, rng)
        drive = road.drive(start, (lambda _: Action.FASTER) if k % 3 == 0 else random_actions(rng))
        envelope = at.envelopes[route]
        rows = np.minimum(drive.places.astype(int), len(envelope.pace) - 1)
        assert np.all(drive.offsets >= envelope.left[rows])
        assert np.all(drive.offsets <= envelope.right[rows])
        assert np.all(drive.turns >= envelope.least_turn[rows])
        assert np.all(drive.turns <= envelope.most_turn[rows])
        # Of all metres that a step covers.
        slowest = [envelope.pace[one : other + 1].min() for one, other in itertools.pairwise(rows)]
        assert np.all(np.diff(drive.places) / 0.1 <= slowest)


def test_measured_alike_for_the_same_seed_and_wider_for_more_drives(world: Callable[..., BoundedWorld]) -> None:
    environment = world("scenario=intersection").environment
    once, again = (measure(environment, 2, 1) for _ in range(2))
    assert sorted(once) == ["south-east", "south-north", "south-west"]
    assert text_of(once) == text_of(again)
    few, more = (measure(environment, drives, 0) for drives in (2, 6))
    for name, wide in more.items():
        narrow = few[name]
        assert np.all(wide.pace >= narrow.pace)
        wider = wide.right - narrow.right, wide.most_turn - narrow.most_turn
        wider += narrow.left - wide.left, narrow.least_turn - wide.least_turn
        assert all(np.all(by >= 0) for by in wider), name
        # In a curve each drive lies another way.
        assert any(np.any(by > 0.01) for by in wider) == (name != "south-north")
    # The right turn is cut, to the right.
    assert more["south-east"].right.max() > 0.3
