"""Who waits for whom: what human drivers do beyond highway-env's rule."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from codriving.datatypes.world import Kind, Start
from codriving.environment.environment import Environment
from codriving.environment.traffic.right_of_way import (
    HORIZON,
    OVERSHOOT,
    STARTING,
    Ahead,
    can_wait,
    meet,
    occupied_ahead,
    pace,
)
from codriving.environment.traffic.route_following import RouteFollower

Build = Callable[..., Environment]
CAV, HDV = Kind.CAV, Kind.HDV


def placed(by_hand: Build, *starts: Start) -> tuple[Environment, dict[str, RouteFollower]]:
    env = by_hand(starts=list(starts))
    env.reset(0)
    return env, {vehicle.id: vehicle for vehicle in env._traffic.vehicles}


def test_a_driver_stops_before_a_zone_that_a_vehicle_is_in(by_hand: Build) -> None:
    stands = Start("CAV1", CAV, "west-east", 113.0, 0.0)
    env, road = placed(by_hand, stands, Start("HDV1", HDV, "south-north", 92.0, 6.0))
    (zone,) = env.road_map.zones("south-north", "west-east")
    assert zone.entry_j < 113.0 < zone.exit_j
    assert occupied_ahead(env.road_map, road["HDV1"], road.values()) == zone.entry_i
    # No vehicle in it, too late to stop, and far away: nothing to wait for.
    for other, place, speed in ((60.0, 92.0, 6.0), (113.0, zone.entry_i - 1.0, 9.0), (113.0, 40.0, 6.0)):
        env, road = placed(
            by_hand, Start("CAV1", CAV, "west-east", other, 0.0), Start("HDV1", HDV, "south-north", place, speed)
        )
        assert occupied_ahead(env.road_map, road["HDV1"], road.values()) is None


def test_a_driver_who_overshoots_a_little_still_waits(by_hand: Build) -> None:
    env, _ = placed(by_hand, Start("CAV1", CAV, "west-east", 60.0, 0.0))
    (zone,) = env.road_map.zones("south-north", "west-east")
    for beyond, waits in ((OVERSHOOT / 2, True), (OVERSHOOT + 0.5, False)):
        driver = Start("HDV1", HDV, "south-north", zone.entry_i + beyond, 0.0)
        env, road = placed(by_hand, Start("CAV1", CAV, "west-east", 113.0, 0.0), driver)
        assert (occupied_ahead(env.road_map, road["HDV1"], road.values()) is not None) == waits


def test_the_driver_comes_to_a_stand_outside_the_bodies(by_hand: Build) -> None:
    stands = Start("CAV1", CAV, "west-east", 113.0, 0.0)
    env, road = placed(by_hand, stands, Start("HDV1", HDV, "south-north", 80.0, 7.0))
    (zone,) = env.road_map.zones("south-north", "west-east")
    for _ in range(100):
        env._traffic.act()
        env._traffic.step(0.1)
        road["CAV1"].speed = 0.0
    assert road["HDV1"].speed < 0.5
    assert road["HDV1"].s <= zone.entry_i + OVERSHOOT


def test_after_waiting_a_driver_wants_the_speed_limit(by_hand: Build) -> None:
    env, road = placed(
        by_hand, Start("CAV1", CAV, "west-east", 20.0, 5.0), Start("HDV1", HDV, "south-north", 60.0, 6.0)
    )
    driver = road["HDV1"]
    env._traffic.enforce_road_rules()
    assert driver.target_speed == 6.0
    driver.waits_at = 100.0  # type: ignore[attr-defined]
    env._traffic.enforce_road_rules()
    assert driver.target_speed == driver.lane.speed_limit == 10.0


def test_a_driver_who_stands_means_to_start_and_a_cav_does_not(by_hand: Build) -> None:
    env, road = placed(
        by_hand, Start("CAV1", CAV, "west-east", 101.0, 0.0), Start("HDV1", HDV, "south-north", 99.0, 0.0)
    )
    assert pace(road["HDV1"]) == STARTING
    assert pace(road["CAV1"]) == 0.0
    env, road = placed(
        by_hand, Start("HDV1", HDV, "south-north", 99.0, 0.0), Start("HDV2", HDV, "west-east", 101.0, 0.0)
    )
    assert meet(env.road_map, Ahead(road["HDV1"]), Ahead(road["HDV2"]))


def test_who_has_braked_to_wait_is_not_let_go_for_its_low_speed(by_hand: Build) -> None:
    # At 5 m/s it would pass behind the other one, but it would not stay at 5 m/s: before, it was let go and crashed.
    starts = [Start("HDV1", HDV, "north-east", 93.0, 5.3), Start("HDV2", HDV, "west-east", 99.8, 6.6)]
    env, road = placed(by_hand, *starts)
    road["HDV1"].target_speed = 10.0
    assert meet(env.road_map, Ahead(road["HDV1"]), Ahead(road["HDV2"]))
    assert meet(env.road_map, Ahead(road["HDV2"]), Ahead(road["HDV1"]))
    road["HDV1"].target_speed = 5.3
    assert not meet(env.road_map, Ahead(road["HDV1"]), Ahead(road["HDV2"])), "it means to stay as slow"
    env._traffic.enforce_road_rules()
    assert road["HDV1"].waits_at is None
    road["HDV1"].target_speed = 10.0
    env._traffic.enforce_road_rules()
    assert road["HDV1"].waits_at == 100.0
    assert road["HDV2"].waits_at is None


def test_it_goes_on_waiting_until_it_passes_behind(by_hand: Build) -> None:
    # Seed 10017 of the intersection: it was told and let go three times, and struck the other one in its side.
    starts = [Start("HDV1", HDV, "north-east", 76.5, 7.2), Start("HDV2", HDV, "west-east", 84.0, 6.6)]
    env, road = placed(by_hand, *starts, Start("CAV1", CAV, "south-east", 20.0, 0.0))
    (zone,) = env.road_map.zones("north-east", "west-east")
    told, behind = 0, []
    for _ in range(120):
        env._traffic.act()
        env._traffic.step(0.1)
        road["CAV1"].speed = 0.0
        told += road["HDV1"].waits_at == 100.0
        if road["HDV1"].s > zone.entry_i:
            behind.append((road["HDV2"].s - zone.entry_j) - (road["HDV1"].s - zone.entry_i))
    assert told >= 8
    assert min(behind) > 10.0


@pytest.mark.parametrize(
    ("nose", "speed", "can"),
    [(-3.0, 5.9, True), (-3.0, 7.0, False), (0.0, 0.0, True), (0.9, 0.0, True), (1.1, 0.0, False)],
)
def test_who_stands_at_the_line_can_wait_also_a_little_over_it(
    nose: float, speed: float, can: bool, by_hand: Build
) -> None:
    # Drivers stop with their front at the line; without an allowance, the one who stood there could not wait any more.
    _, road = placed(by_hand, Start("HDV1", HDV, "south-north", 100.0 - 2.5 + nose, speed))
    assert can_wait(road["HDV1"]) == can


@given(speed=st.floats(0, 10), wish=st.floats(0, 12))
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_motions_are_constant_speed_and_speeding_up(speed: float, wish: float, by_hand: Build) -> None:
    starts = [Start("CAV1", CAV, "west-east", 50.0, speed), Start("HDV1", HDV, "south-north", 60.0, speed)]
    _, road = placed(by_hand, *starts)
    road["HDV1"].target_speed = wish
    (steady,) = Ahead(road["CAV1"]).places(len(HORIZON))
    np.testing.assert_allclose(steady, 50.0 + speed * HORIZON)
    slower, faster = Ahead(road["HDV1"]).places(len(HORIZON))
    np.testing.assert_allclose(slower, 60.0 + max(speed, STARTING) * HORIZON)
    assert (faster >= slower).all()
    # Never faster than it wants, nor than the speed limit, unless it is already.
    top = max(speed, STARTING, min(wish, 10.0))
    assert (np.diff(faster) <= top * 0.25 + 1e-9).all()
    if min(wish, 10.0) > speed + 0.1 and speed > STARTING:
        assert faster[0] == pytest.approx(
            60.0 + speed * 0.25 + 1.5 * min(0.25, (min(wish, 10.0) - speed) / 3) ** 2, abs=0.3
        )
        assert faster[-1] > slower[-1]


@given(speed=st.floats(0, 14), wish=st.floats(0, 14), place=st.floats(0, 150))
@settings(deadline=None, max_examples=30, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_the_reach_is_the_last_of_the_places(speed: float, wish: float, place: float, by_hand: Build) -> None:
    starts = Start("CAV1", CAV, "west-east", 50.0, speed), Start("HDV1", HDV, "south-north", 60.0, speed)
    _, road = placed(by_hand, *starts)
    road["HDV1"].target_speed = wish
    for vehicle in road.values():
        for spot in (None, ("north-south", place)):
            for count in (1, 5, len(HORIZON)):
                assert Ahead(vehicle, spot=spot).reach(count) == Ahead(vehicle, spot=spot).places(count)[-1, -1]


def test_drivers_look_more_often_than_highway_env_lets_them(by_hand: Build) -> None:
    looks = {}
    for off in ((), ("yield_at_entry",)):
        env = by_hand(*off, starts=[Start("HDV1", HDV, "south-north", 20.0, 6.0)])
        env.reset(0)
        counted = []
        env._traffic.enforce_road_rules = lambda counted=counted: counted.append(1)  # type: ignore[method-assign]
        for _ in range(10):
            env._traffic.act()
            env._traffic.step(0.1)
        looks[off] = len(counted)
    assert looks == {(): 5, ("yield_at_entry",): 2}
