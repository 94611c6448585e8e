"""Where two CAVs cannot be together: for certain, whatever they do between two looks of the environment."""

import itertools
from collections.abc import Callable

import numpy as np
import pytest

from codriving.bound.measure import LoneDrive, LoneRoad, random_actions
from codriving.bound.meetings import Margins, between_looks, kept_meetings, sure_meetings, sure_overlap
from codriving.bound.passing import Passing
from codriving.bound.world import BoundedWorld
from codriving.datatypes import Action, Kind, Start
from codriving.geometry import TRUE, FloatArray, corners, overlaps


def test_no_step_leads_across_what_is_kept_of_a_forbidden_set() -> None:
    a, b = np.mgrid[0:40, 0:40]
    disc = (a - 20) ** 2 + (b - 20) ** 2 <= 64
    # Inside are the squares all of whose corners are.
    square = disc[:-1, :-1] & disc[1:, :-1] & disc[:-1, 1:] & disc[1:, 1:]
    kept, rng = between_looks(disc, 2.0, 2.0), np.random.default_rng(3)
    assert 0.6 * disc.sum() < kept.sum() < disc.sum()
    for place in np.argwhere(kept):
        for _ in range(12):
            step, share = rng.uniform(0.0, 2.0, 2), rng.uniform()
            ends = (place - share * step, place + (1 - share) * step)
            assert any(square[tuple(np.floor(end).astype(int))] for end in ends)


def _passing(world: BoundedWorld, name: str, route: str, place: float, speed: float = 9.0) -> Passing:
    start = Start(name, Kind.CAV, route, place, speed)
    road = LoneRoad(world.environment)
    drive = road.drive(start, lambda _: Action.FASTER)
    assert world.envelopes is not None
    return Passing(start, road.road_map.routes[route], drive.places, world.envelopes[route], 0.1, 9.0)


def test_who_drives_ahead_goes_first_and_ways_that_part_do_not_meet(world: Callable[..., BoundedWorld]) -> None:
    at = world("scenario=intersection")
    cavs = [_passing(at, "CAV1", "south-north", 30), _passing(at, "CAV2", "south-west", 60)]
    (meeting,) = sure_meetings(cavs, at.environment.road_map, 0.1)
    assert meeting.first == 1
    # A body of 5 m, less what bodies that turn do not cover for certain.
    assert all(3.0 <= a - b <= 5.0 for b, a in meeting.rows(1) if b < 90)
    cavs = [_passing(at, "CAV1", "south-east", 60), _passing(at, "CAV2", "west-south", 60)]
    assert not list(sure_meetings(cavs, at.environment.road_map, 0.1))


def test_start_inside_a_zone_goes_first(world: Callable[..., BoundedWorld]) -> None:
    at = world("scenario=intersection")
    found = []
    for place in (100.0, 110.0, 121.0):
        cavs = [_passing(at, "CAV1", "south-north", place), _passing(at, "CAV2", "west-east", 60)]
        found.append([meeting.first for meeting in sure_meetings(cavs, at.environment.road_map, 0.1)])
    assert found == [[None], [0], []]


def test_goal_inside_a_zone_ends_it_since_who_has_arrived_is_gone(world: Callable[..., BoundedWorld]) -> None:
    at = world("scenario=intersection")
    cavs = [_passing(at, "CAV1", "south-north", 60), _passing(at, "CAV2", "east-north", 60)]
    goals = [cav.route.goal for cav in cavs]
    for meetings in (
        list(sure_meetings(cavs, at.environment.road_map, 0.1)),
        list(kept_meetings(cavs, at.environment.road_map, Margins())),
    ):
        rows = [row for meeting in meetings for row in meeting.rows_i]
        # The second is still behind the first when that one is at its goal, and not told to be where that is gone.
        assert max(a for _, a in rows) == pytest.approx(goals[0], abs=0.5)
        assert max(a for _, a in rows) <= goals[0]
        assert goals[1] - 8.0 < max(b for b, _ in rows) <= goals[1]


def test_margins_are_kept_at_crossings_and_less_on_common_ways(world: Callable[..., BoundedWorld]) -> None:
    at = world("scenario=intersection")
    cavs = [_passing(at, "CAV1", "south-north", 60), _passing(at, "CAV2", "west-east", 60)]
    (bare,) = kept_meetings(cavs, at.environment.road_map, Margins(0.6, 0.0))
    (padded,) = kept_meetings(cavs, at.environment.road_map, Margins(0.6, 1.0))
    assert padded.rows(0)[0][1] == pytest.approx(bare.rows(0)[0][1] + 1.0)
    (sure,) = sure_meetings(cavs, at.environment.road_map, 0.1)
    assert bare.rows(0)[-1][1] > sure.rows(0)[-1][1]
    merging = [_passing(at, "CAV1", "south-north", 60), _passing(at, "CAV2", "east-north", 60)]
    (bare,) = kept_meetings(merging, at.environment.road_map, Margins(0.6, 0.0))
    (padded,) = kept_meetings(merging, at.environment.road_map, Margins(0.6, 1.0))
    assert padded.rows(0)[-1] == bare.rows(0)[-1]


@pytest.mark.parametrize("suite", ["default", "paper"])
def test_drives_that_just_do_not_touch_are_not_inside(world: Callable[..., BoundedWorld], suite: str) -> None:
    at = world("scenario=intersection", f"suite={suite}")
    road, rng = LoneRoad(at.environment), np.random.default_rng(11)
    assert at.envelopes is not None
    pairs = (("south-west", "east-west"), ("south-north", "west-east"), ("south-west", "north-south"))
    checked = 0
    for routes in pairs:
        drives = []
        for route in routes:
            start = Start("CAV1", Kind.CAV, route, 70.0, float(rng.uniform(3, 9)))
            drives.append(road.drive(start, random_actions(rng)))
        boxes = [_boxes(at, route, drive) for route, drive in zip(routes, drives, strict=True)]
        mask = sure_overlap(at.environment.road_map, *routes, *(at.envelopes[r] for r in routes), 0.99)
        spacings = [at.environment.road_map.paths[r].spacing for r in routes]
        touched = [_touch(boxes, shift) for shift in range(-120, 121)]
        for shift, (now, after) in enumerate(itertools.pairwise(touched), start=-120):
            if now == after:
                continue
            checked += 1
            free = shift if not now else shift + 1
            places = np.array([[d.places[k] for d, k in zip(drives, ks, strict=True)] for ks in _together(boxes, free)])
            for row in places:
                low = [int(np.floor(s / w)) for s, w in zip(row, spacings, strict=True)]
                corner = mask[low[0] : low[0] + 2, low[1] : low[1] + 2]
                assert not corner.all(), (routes, free, row)
    assert checked >= 4


def _boxes(world: BoundedWorld, route: str, drive: LoneDrive) -> FloatArray:
    path = world.environment.road_map.paths[route]
    x, y = path.position(drive.places)
    heading = path.heading(drive.places)
    x, y = x - drive.offsets * np.sin(heading), y + drive.offsets * np.cos(heading)
    return corners(x, y, heading + drive.turns, TRUE.length, TRUE.width)


def _together(boxes: list[FloatArray], shift: int) -> list[tuple[int, int]]:
    return [(k, k + shift) for k in range(len(boxes[0])) if 0 <= k + shift < len(boxes[1])]


def _touch(boxes: list[FloatArray], shift: int) -> bool:
    pairs = _together(boxes, shift)
    if not pairs:
        return False
    one, other = (boxes[n][[pair[n] for pair in pairs]] for n in (0, 1))
    return bool(overlaps(one, other).any())
