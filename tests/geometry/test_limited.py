"""Vehicles with limits are predicted as the environment moves them, and no driver leaves the bounds."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from codriving.datatypes.limits import VehicleLimits
from codriving.datatypes.road import Arc, Lane, Road, Route, Straight, Turn
from codriving.datatypes.world import Action, DrivingModel
from codriving.geometry.limited import accelerated, driven
from codriving.geometry.road_map import RoadMap
from codriving.reasoning.prediction.forecast import Forecast
from codriving.reasoning.prediction.rollout import PLANS, rollout

LIMITS = VehicleLimits(4.0, 8.0, 4.0, 3.0, 2.4)
MODEL = DrivingModel((0.0, 5.0, 10.0, 15.0), 1.6, 0.1, 0.5, 50.0, LIMITS, 6.0, 3.0)
BEND = RoadMap(
    Road(
        "bend",
        (
            Lane(("a", "b", 0), Straight((0.0, 0.0), (150.0, 0.0)), speed_limit=16.0),
            Lane(("b", "c", 0), Arc((150.0, 12.0), 12.0, -np.pi / 2, 0.0, True), speed_limit=16.0),
            Lane(("c", "d", 0), Straight((162.0, 12.0), (162.0, 190.0)), speed_limit=16.0),
        ),
        (Route("round", (("a", "b", 0), ("b", "c", 0), ("c", "d", 0)), Turn.RIGHT, entry=150.0, goal=330.0),),
    )
)
PROFILE = BEND.speed_profiles(MODEL)["round"]
SPEEDS, PLACES, PEDALS = st.floats(0.0, 16.0), st.floats(0.0, 220.0), st.lists(st.floats(-6.0, 3.0), min_size=1)


def followed(speed: float, target: float, plan: tuple[Action, ...], place: float, steps: int) -> list[float]:
    """The place at each step, one state and step at a time."""
    start, places = place, [0.0]
    for n in range(steps):
        if n % 5 == 0:
            change = {Action.SLOWER: -1, Action.FASTER: 1}.get(plan[min(n // 5, len(plan) - 1)], 0)
            index = round(min(max(speed / 5.0, 0.0), 3.0)) + change
            target = 5.0 * min(max(index, 0), 3) if change else target
        pedal = min(1.6 * (target - speed), PROFILE.acceleration(place, speed))
        place, speed = place + 0.1 * speed, speed + 0.1 * min(max(pedal, -8.0), 4.0)
        places.append(place - start)
    return places


@given(SPEEDS, st.sampled_from([0.0, 5.0, 10.0, 15.0]), PLACES, st.sampled_from(PLANS))
def test_every_plan_is_simulated_along_the_curve(
    speed: float, target: float, place: float, plan: tuple[Action, ...]
) -> None:
    distances, _ = rollout(MODEL, [speed], [target], (plan,), 80, ((PROFILE, place),))
    assert distances[0, 0] == pytest.approx(followed(speed, target, plan, place, 80), abs=1e-9)


def test_a_forecast_leaves_out_curves_that_are_not_reached() -> None:
    forecast = Forecast(MODEL, PLANS, BEND)
    assert forecast.along(10.0, ("round", 180.0)) == ()
    assert forecast.along(10.0, ("round", 100.0)) == ((PROFILE, 100.0),)
    past, before = (forecast.travel(6.0, 10.0, PLANS, ("round", s)) for s in (180.0, 100.0))
    assert np.array_equal(past, forecast.travel(6.0, 10.0, PLANS))
    assert (before <= past + 1e-9).all()
    assert before[0, -1] < past[0, -1] - 10.0


def test_limits_that_are_never_reached_change_nothing() -> None:
    wide, none = replace(MODEL, limits=VehicleLimits(12.0, 12.0, 12.0, 3.0, 2.4)), replace(MODEL, limits=None)
    speeds, targets = [0.0, 4.0, 9.0], [5.0, 5.0, 10.0]
    plans = ((Action.IDLE,), (Action.IDLE, Action.FASTER))
    for ours, theirs in zip(
        rollout(wide, speeds, targets, plans, 90), rollout(none, speeds, targets, plans, 90), strict=True
    ):
        assert np.allclose(ours, theirs, rtol=0, atol=1e-9)


@given(SPEEDS, PLACES, PEDALS)
def test_no_driver_leaves_the_bounds(speed: float, place: float, pedals: list[float]) -> None:
    forecast = Forecast(MODEL, (), BEND)
    reach = forecast.reach(speed, False, ("round", place))
    s, v = place, speed
    for n in range(100):
        if n % 2 == 0:
            assert reach.least[n // 2] <= s - place + 1e-9
            assert s - place <= reach.most[n // 2] + 1e-9
        free = min(pedals[n // 10 % len(pedals)], (16.0 - v) / 0.1 if v <= 16.0 else 0.0)
        wanted = min(free, PROFILE.acceleration(s, v))
        s, v = s + 0.1 * v, max(v + 0.1 * min(max(wanted, -6.0), 3.0), 0.0)


@given(st.floats(0.0, 6.0), st.floats(130.0, 168.0), st.floats(0.0, 0.7), st.booleans())
@example(6.0, 149.0, 0.7, True)
def test_none_leaves_the_bounds_by_cutting_the_corner(speed: float, place: float, inside: float, is_cav: bool) -> None:
    forecast = Forecast(MODEL, (), BEND)
    forecast.begin_step([(speed, 15.0, "round", place)])
    most = forecast.reach(speed, is_cav, ("round", place)).most
    s, v, pedal = place, speed, 4.0 if is_cav else 3.0
    for n in range(100):
        assert n % 2 or s - place <= most[n // 2] + 1e-9
        wanted = min(1.6 * (15.0 - v), PROFILE.acceleration(s, v), pedal)
        # The arc of 12 m is driven along a circle that is smaller by so much.
        s, v = s + 0.1 * v / (1 - inside / 12.0 * (150.0 <= s < 168.85)), v + 0.1 * max(wanted, -6.0)


@given(st.sampled_from([0.0, 3.0, 7.0, 12.0]), PLACES, st.lists(st.sampled_from(list(Action)), min_size=1, max_size=6))
def test_no_plan_leaves_the_bounds(speed: float, place: float, plan: list[Action]) -> None:
    forecast = Forecast(replace(MODEL, steady=True), (tuple(plan),), BEND)
    for target in (0.0, 5.0, 10.0, 15.0):
        forecast.begin_step([(speed, target, "round", place)])
        reach = forecast.reach(speed, True, ("round", place))
        (travel,) = forecast.travel(speed, target, [tuple(plan)], ("round", place))
        assert (reach.least <= travel + 1e-9).all()
        assert (travel <= reach.most + 1e-9).all()


def test_a_driver_is_expected_to_slow_down_for_the_curve() -> None:
    forecast = Forecast(MODEL, (), BEND)
    steady = forecast.reach(15.0, False, ("round", 100.0)).steady
    assert steady[5] == pytest.approx(14.85, abs=0.1)
    # From 150 to 169 m at 6 m/s takes 3.1 s.
    there = [float(np.interp(s - 100.0, steady, forecast.times)) for s in (151.0, 168.0)]
    assert there[1] - there[0] == pytest.approx(17.0 / 6.0, abs=0.2)
    least, most = forecast.likely(15.0, ("round", 100.0))
    assert ((least <= steady) & (steady <= most)).all()


def test_a_free_road_is_driven_as_without_a_profile() -> None:
    times = np.linspace(0.0, 10.0, 51)
    assert np.array_equal(driven((PROFILE, 180.0), 5.0, 16.0, 3.0, times), accelerated(5.0, times, 16.0, 3.0))


def test_samples_until_a_lane_is_left_follow_from_the_limits() -> None:
    assert Forecast(replace(MODEL, limits=None), (), BEND).clears == 9
    # 3.11 s at 0.2 s each, and the sample of now.
    assert Forecast(MODEL, (), BEND).clears == 17


def test_a_zone_is_passed_at_the_speed_of_the_curve() -> None:
    assert Forecast(replace(MODEL, limits=None), (), BEND).duration(("round", 152.0), 12.0) == pytest.approx(0.8)
    assert Forecast(MODEL, (), BEND).duration(("round", 152.0), 12.0) == pytest.approx(2.0, abs=0.01)
