"""The bound itself: by hand, by enumeration, and by what has to leave it as it is."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from codriving.bound.envelope import Envelope
from codriving.bound.meetings import Margins, MeetingPlace, sure_meetings
from codriving.bound.passing import Passing
from codriving.bound.program import pose
from codriving.bound.solve import lower_bound, solved
from codriving.bound.timetable import Timetable
from codriving.bound.world import BoundedWorld
from codriving.datatypes import Kind, Route, Start, Turn
from codriving.geometry import TRUE

WORLDS = [("scenario=intersection", "scenario.cavs=8"), ("scenario=roundabout", "scenario.cavs=8")]


def steady(place: float, goal: float = 100.0, name: str = "CAV1") -> Passing:
    """A CAV that drives 10 m/s from the beginning and cannot be faster."""
    flat = np.zeros(200)
    envelope = Envelope(0.0, np.full(200, 10.0), flat, flat, flat, flat)
    route = Route(name, (), Turn.STRAIGHT, 50.0, goal)
    return Passing(
        Start(name, Kind.CAV, name, place, 10.0), route, np.arange(place, goal + 0.5, 1.0), envelope, 0.1, 10.0
    )


def total(cavs: Sequence[Passing], meetings: Sequence[MeetingPlace], gap: float = 0.0) -> float:
    table = Timetable(cavs, meetings, gap, 0.1)
    return solved(table, pose(table)).total


def test_two_that_never_meet_arrive_as_if_alone() -> None:
    assert total([steady(0), steady(20)], []) == pytest.approx(10.0 + 8.0)


def test_crossing_costs_what_the_second_has_to_wait() -> None:
    # Both are 50 m before the crossing. The second may be at 50 m when the first is at 56 m: 0.6 s later than alone.
    meeting = MeetingPlace(0, 1, None, ((50.0, 56.0),), ((50.0, 57.0),))
    assert total([steady(0), steady(0)], [meeting]) == pytest.approx(20.6)
    assert total([steady(0), steady(0)], [meeting], 1.5) == pytest.approx(22.1)
    # Where the other one has to go first.
    assert total([steady(0), steady(0)], [replace(meeting, first=1)]) == pytest.approx(20.7)
    # The one that is 10 m ahead is away in time.
    assert total([steady(10), steady(0)], [meeting]) == pytest.approx(19.0)


def test_at_two_zones_other_orders_may_be_best_than_at_all() -> None:
    # Three CAVs in a circle: each goes first at one of its two zones; in one order of vehicles it takes longer.
    rows = ((60.0, 40.0),)
    late = ((40.0, 70.0),)
    circle = [
        MeetingPlace(0, 1, None, rows, late),
        MeetingPlace(1, 2, None, rows, late),
        MeetingPlace(0, 2, None, late, rows),
    ]
    cavs = [steady(0), steady(0), steady(0)]
    table = Timetable(cavs, circle, 0.0, 0.1)
    assert solved(table, pose(table)).total == pytest.approx(30.0)
    assert solved(table, pose(table, one_order=True)).total > 30.5


@pytest.mark.parametrize("overrides", WORLDS)
def test_solver_finds_what_trying_all_orders_finds(
    world: Callable[..., BoundedWorld], overrides: tuple[str, ...]
) -> None:
    at, compared = world(overrides[0]), 0
    for seed in range(24_000, 24_030):
        cavs = at.cavs(seed)
        meetings = list(sure_meetings(cavs, at.environment.road_map, 0.1))
        free = [n for n, meeting in enumerate(meetings) if meeting.first is None]
        if not 2 <= len(free) <= 4:
            continue
        table, best = Timetable(cavs, meetings, 0.0, 0.1), np.inf
        for choice in product((0, 1), repeat=len(free)):
            firsts = {n: meeting.first for n, meeting in enumerate(meetings)}
            firsts |= {n: (meetings[n].i, meetings[n].j)[pick] for n, pick in zip(free, choice, strict=True)}
            times = table.with_firsts(firsts)
            best = min(best, sum(max(t[-1], cav.arrival) for t, cav in zip(times, cavs, strict=True)))
        found = lower_bound(cavs, at.environment.road_map, 0.1)
        assert found.optimal
        assert found.binaries == len(free)
        assert best - 1e-3 <= found.total <= best + 0.1
        compared += 1
        if compared == 4:
            break
    assert compared == 4


@pytest.mark.parametrize("overrides", WORLDS)
def test_another_cav_never_lowers_what_is_lost(world: Callable[..., BoundedWorld], overrides: tuple[str, ...]) -> None:
    at = world(*overrides)
    for seed in (24_100, 24_101):
        cavs, before = at.cavs(seed), 0.0
        for count in (3, 5, 8):
            bound = lower_bound(cavs[:count], at.environment.road_map, 0.1)
            assert bound.total - bound.alone >= before - 0.1
            before = bound.total - bound.alone


@pytest.mark.parametrize("overrides", WORLDS)
def test_order_of_the_cavs_makes_no_difference(world: Callable[..., BoundedWorld], overrides: tuple[str, ...]) -> None:
    at = world(*overrides)
    for seed in (24_200, 24_201):
        cavs = at.cavs(seed)
        one, other = (lower_bound(order, at.environment.road_map, 0.1) for order in (cavs, cavs[::-1]))
        assert one.total == pytest.approx(other.total, abs=0.11)
        assert one.binaries == other.binaries


def test_quarter_turn_makes_no_difference(world: Callable[..., BoundedWorld]) -> None:
    at, legs = world(*WORLDS[0]), ("south", "west", "north", "east")

    def turned(cav: Passing) -> Passing:
        route = "-".join(legs[(legs.index(leg) + 1) % 4] for leg in cav.route.id.split("-"))
        start, routes = replace(cav.start, route=route), at.environment.road_map.routes
        return Passing(start, routes[route], cav.alone, at.envelopes[route], 0.1, 9.0)

    for seed in (24_300, 24_301):
        cavs = at.cavs(seed)
        one, other = (lower_bound(some, at.environment.road_map, 0.1) for some in (cavs, [turned(c) for c in cavs]))
        # Points of paths that touch a zone by a hair are in it on one leg and not on another.
        assert one.total == pytest.approx(other.total, abs=0.21)


def test_margins_cost_more_than_not_touching_and_one_order_more_than_orders_by_zone(
    world: Callable[..., BoundedWorld],
) -> None:
    at = world("scenario=roundabout", "scenario.cavs=8")
    by_zone = one = 0.0
    for seed in (24_400, 24_401):
        cavs, road = at.cavs(seed), at.environment.road_map
        small = lower_bound(cavs, road, 0.1, Margins(0.6, 0.0, TRUE)).total
        bounds = [
            lower_bound(cavs, road, 0.1),
            lower_bound(cavs, road, 0.1, Margins()),
            lower_bound(cavs, road, 0.1, Margins(), one_order=True),
        ]
        assert bounds[0].total <= small + 0.1 <= bounds[1].total + 0.2
        assert bounds[1].total <= bounds[2].total + 0.1
        by_zone, one = by_zone + bounds[1].total, one + bounds[2].total
    assert one > by_zone + 0.5
