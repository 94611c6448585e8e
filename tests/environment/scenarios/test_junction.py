"""Scenes at junctions: one CAV a leg at once, rows of them, turns that are left out, and an exit that is blocked."""

import re
from collections import Counter
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from starting import can_brake, check_room, scenario

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.world import Kind, Scene, Start
from codriving.environment.scenarios.junction import JunctionScenario
from codriving.errors import ConfigError

BOTH = ("intersection", "roundabout")
STANDOFF: dict[str, Any] = {"pattern": "standoff", "start": (20.0, 70.0), "cav_speed": (8.0, 8.0)}


def junction(name: str, **change: Any) -> JunctionScenario:
    made = scenario(name, **change)
    assert isinstance(made, JunctionScenario)
    return made


def leg(start: Start) -> str:
    return start.route.split("-")[0]


def out(start: Start) -> str:
    return start.route.split("-")[1]


def cavs(scene: Scene) -> list[Start]:
    return [start for start in scene.starts if start.kind is Kind.CAV]


@pytest.mark.parametrize("name", BOTH)
def test_a_yaml_of_release_0_1_makes_the_scenes_of_today(name: str) -> None:
    node = compose([f"scenario={name}"])["scenario"]
    later = [key for key in ("pattern", "row_gap", "turns", "blocked_exit", "blocked_room", "blind") if key in node]
    old, today = (
        build({key: value for key, value in node.items() if key not in left_out}, JunctionScenario, "scenario")
        for left_out in (later, ())
    )
    assert len(later) >= 5
    assert [getattr(old, key) for key in later] == [getattr(today, key) for key in later]
    assert [old.scene(seed) for seed in range(5)] == [today.scene(seed) for seed in range(5)]


@pytest.mark.parametrize("name", BOTH)
def test_four_cavs_come_at_once_each_by_a_leg_of_its_own(name: str) -> None:
    of = junction(name, **STANDOFF, turns=("left", "straight"))
    routes = {route.id: route for route in of.road.routes}
    scenes = [of.scene(seed) for seed in range(40)]
    for scene in scenes:
        assert sorted(leg(start) for start in cavs(scene)) == ["east", "north", "south", "west"]
        assert {(start.position, start.speed) for start in cavs(scene)} == {(70.0, 8.0)}
        assert {routes[start.route].turn for start in scene.starts} <= {"left", "straight"}
    assert len({tuple(leg(start) for start in cavs(scene)) for scene in scenes}) > 15, "who comes by which leg is drawn"


@pytest.mark.parametrize("name", BOTH)
def test_further_cavs_come_in_rows_behind(name: str) -> None:
    of = junction(name, **STANDOFF, cavs=7)
    for seed in range(20):
        starts = cavs(of.scene(seed))
        assert [start.position for start in starts] == [70.0] * 4 + [56.0] * 3
        assert len({leg(start) for start in starts[4:]}) == 3
    wide = junction(name, **STANDOFF, cavs=8, row_gap=20.0)
    assert {start.position for start in cavs(wide.scene(0))[4:]} == {50.0}


def test_rows_start_at_the_speeds_at_which_they_can_brake() -> None:
    of = junction("intersection", pattern="standoff", cavs=8)
    for seed in range(20):
        for behind in cavs(of.scene(seed))[4:]:
            (ahead,) = (start for start in cavs(of.scene(seed))[:4] if leg(start) == leg(behind))
            assert can_brake(behind, ahead, 14.0)


def test_turns_are_left_out_for_all() -> None:
    of = junction("intersection", turns=("left",))
    routes = {start.route for seed in range(40) for start in of.scene(seed).starts}
    assert routes == {"south-west", "west-north", "north-east", "east-south"}


@pytest.mark.parametrize("name", BOTH)
@settings(max_examples=40, deadline=None)
@given(
    seed=st.integers(0, 2**31 - 1),
    number=st.integers(2, 12),
    hdvs=st.integers(0, 4),
    row_gap=st.floats(13.4, 17),
    slowest=st.floats(0, 8),
    blocked=st.sampled_from([0.0, 20.0]),
    room=st.floats(1, 20),
)
def test_no_vehicle_starts_inside_another_and_each_can_brake(
    name: str, seed: int, number: int, hdvs: int, row_gap: float, slowest: float, blocked: float, room: float
) -> None:
    change = {"cavs": number, "hdvs": (0, hdvs), "row_gap": row_gap, "cav_speed": (slowest, 8.0)}
    of = junction(name, pattern="standoff", **change, blocked_exit=blocked, blocked_room=room)
    scene = of.scene(seed)
    ends = {route.id: route.goal - of.exit_distance for route in of.road.routes}
    for one in ("south", "west", "north", "east"):
        check_room([s for s in scene.starts if leg(s) == one and s.position < 100.0], 10.0)
    for blocker in (start for start in scene.starts if start.stands):
        place = blocker.position - ends[blocker.route]
        assert place == pytest.approx(room + 2.5)
        for start in scene.starts:
            if out(start) == out(blocker) and start is not blocker:
                assert can_brake(start, blocker, ends[start.route] + place - start.position)


def test_a_vehicle_stands_past_an_exit_that_two_cavs_want() -> None:
    """The junction begins after 100 m and is 22 m across; 7 m further begins the rear of a car of 5 m."""
    of = junction("intersection", blocked_exit=20.0)
    exits = Counter[str]()
    for seed in range(40):
        *others, blocker = of.scene(seed).starts
        assert (blocker.id, blocker.kind) == (f"HDV{len(others) - 3}", Kind.HDV)
        assert (blocker.position, blocker.speed, blocker.stands) == (131.5, 0.0, 20.0)
        assert blocker.route in ("south-north", "north-south", "west-east", "east-west")
        assert sum(out(start) == out(blocker) for start in others if start.kind is Kind.CAV) >= 2
        assert not any(start.stands for start in others)
        exits[out(blocker)] += 1
    assert len(exits) == 4


def test_a_vehicle_stands_past_an_exit_of_the_roundabout() -> None:
    """The exits touch the ring of 20 m with arcs of 15 m."""
    of = junction("roundabout", blocked_exit=5.0, blocked_room=4.0)
    for seed in range(20):
        blocker = of.scene(seed).starts[-1]
        route = next(route for route in of.road.routes if route.id == blocker.route)
        assert blocker.position == pytest.approx(route.goal - 20.0 + 4.0 + 2.5)


@pytest.mark.parametrize("name", BOTH)
def test_a_blocked_exit_changes_nothing_else(name: str) -> None:
    plain, blocked = junction(name), junction(name, blocked_exit=20.0)
    same = 0
    for seed in range(60):
        before, now = plain.scene(seed), blocked.scene(seed)
        shared = Counter(out(start) for start in cavs(before)).most_common(1)[0][1]
        if shared >= 2 and now.starts[:-1] == before.starts:
            same += 1
        assert blocked.scene(seed) == now
        # At the roundabout one may also be too close to the exit to brake.
        if name == "intersection":
            assert (now.starts[:-1] == before.starts) == (shared >= 2)
    assert same > 30


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"turns": ()}, "turns must name one or more of left, straight, right, each once, got []"),
        ({"turns": ("left", "left")}, "turns must name one or more of left, straight, right, each once, got [left, "),
        ({"row_gap": 5.0}, "row_gap must be 6 to 200 m, got 5"),
        ({"blocked_exit": -1.0}, "blocked_exit must be 0 to 600 s, got -1"),
        ({"blocked_room": 0.5}, "blocked_room must be 1 to 100 m, got 0.5"),
        (
            {"blocked_exit": 20.0, "blocked_room": 26.0},
            "blocked_room must be at most exit_distance, 25 m, got 26: past it vehicles have arrived",
        ),
        (
            {"pattern": "standoff", "cavs": 5, "row_gap": 10.0, "cav_speed": (8.0, 9.0)},
            "row_gap 10 m leaves CAVs that start at 8 m/s or more no room to brake; use 13.4 m or more, or a lower "
            "cav_speed or spacing",
        ),
        (
            {"pattern": "standoff", "cavs": 12, "row_gap": 30.0},
            "12 CAVs on 4 legs would start as far back as 15 m, and start begins at 20 m; use fewer CAVs, a smaller "
            "row_gap or a longer start interval",
        ),
        (
            {"pattern": "standoff", "cavs": 12, "hdvs": (2, 5), "start": (25.0, 70.0)},
            "up to 5 HDVs cannot start behind 12 CAVs in rows 14 m apart within 25 to 70 m along 4 legs, where 4 have "
            "room; use fewer vehicles or a longer start interval",
        ),
        (
            {"pattern": "standoff", "turns": ("straight",), "blocked_exit": 20.0},
            "blocked_exit needs an exit that 2 CAVs want, and 4 CAVs who come by a leg each and all go straight want "
            "one each; use more turns or more than 4 CAVs",
        ),
    ],
)
def test_settings_that_do_not_fit_are_refused(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ConfigError, match=re.escape(message)):
        junction("intersection", **change)
    junction("intersection", pattern="standoff", cavs=5, row_gap=13.4, cav_speed=(8.0, 9.0))


def test_five_who_all_go_straight_share_an_exit() -> None:
    of = junction("intersection", pattern="standoff", turns=("straight",), blocked_exit=20.0, cavs=5)
    for seed in range(5):
        last = cavs(of.scene(seed))[4]
        assert out(of.scene(seed).starts[-1]) == out(last)


@pytest.mark.parametrize("name", ["merge", "highway"])
def test_roads_without_legs_know_none_of_it(name: str) -> None:
    with pytest.raises(TypeError, match="pattern"):
        scenario(name, pattern="standoff")
