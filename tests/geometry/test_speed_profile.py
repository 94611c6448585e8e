"""How fast a route can be driven at each place."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from codriving.datatypes.limits import VehicleLimits
from codriving.datatypes.road import Arc, Lane, Road, Route, Straight, Turn
from codriving.datatypes.world import DrivingModel
from codriving.geometry.road_map import RoadMap

LIMITS = VehicleLimits(4.0, 8.0, 4.0, 3.0, 2.4)
MODEL = DrivingModel((0.0, 5.0, 10.0, 15.0), 1.6, 0.1, 0.5, 50.0, LIMITS)
BEND = Road(
    "bend",
    (
        Lane(("a", "b", 0), Straight((0.0, 0.0), (150.0, 0.0))),
        Lane(("b", "c", 0), Arc((150.0, 12.0), 12.0, -np.pi / 2, 0.0, True)),
        Lane(("c", "d", 0), Straight((162.0, 12.0), (162.0, 90.0))),
    ),
    (Route("round", (("a", "b", 0), ("b", "c", 0), ("c", "d", 0)), Turn.RIGHT, entry=150.0, goal=230.0),),
)
CHANGE = Road(
    "change",
    (
        Lane(("a", "b", 0), Straight((0.0, 0.0), (200.0, 0.0))),
        Lane(("a", "b", 1), Straight((0.0, 4.0), (200.0, 4.0))),
        Lane(("b", "c", 0), Straight((200.0, 0.0), (300.0, 0.0))),
    ),
    (Route("over", (("a", "b", 1), ("a", "b", 0), ("b", "c", 0)), Turn.STRAIGHT, entry=200.0, goal=280.0, taper=15.0),),
)
PROFILE = RoadMap(BEND).speed_profiles(MODEL)["round"]


def test_without_limits_there_is_no_profile() -> None:
    assert RoadMap(BEND).speed_profiles(replace(MODEL, limits=None)) == {}


def test_a_curve_is_driven_in_comfort_and_braked_for() -> None:
    profile = RoadMap(BEND).speed_profiles(MODEL)["round"]
    at = dict(zip(np.round(np.arange(len(profile.speeds)) * profile.spacing).tolist(), profile.speeds, strict=True))
    # sqrt(3 m/s2 * 12 m) on the arc of 18.8 m that begins at 150 m.
    assert profile.speeds.min() == pytest.approx(6.0, abs=0.02)
    assert at[160] == pytest.approx(6.0, abs=0.02)
    # 100 m before the arc, whose curvature counts from a little before it on: sqrt(36 + 2 * 2.4 * 98) = 22.5 m/s.
    assert at[50] == pytest.approx(22.5, abs=0.3)
    assert at[180] == 100.0


def test_a_vehicle_that_is_told_the_reference_keeps_the_speed() -> None:
    profile = RoadMap(BEND).speed_profiles(MODEL)["round"]
    place, speed, over = 20.0, 15.0, []
    while place < 200.0:
        over.append(speed - float(np.interp(place, np.arange(len(profile.speeds)) * profile.spacing, profile.speeds)))
        pedal = min(1.6 * (15.0 - speed), profile.acceleration(place, speed))
        assert pedal > -2.8
        place, speed = place + 0.1 * speed, speed + 0.1 * pedal
    assert max(over) < 0.02


def test_the_way_over_to_the_lane_beside_is_no_curve() -> None:
    assert RoadMap(CHANGE).speed_profiles(MODEL)["over"].values.min() == 100.0


def test_the_shortest_time_is_that_of_the_profile() -> None:
    profile = RoadMap(BEND).speed_profiles(MODEL)["round"]
    # 15 m/s at most on the straight, where 12.2 m are needed to brake from 15 to 6 only near the arc.
    assert profile.duration(0.0, 60.0) == pytest.approx(4.0, abs=0.01)
    assert profile.duration(60.0, -60.0) == pytest.approx(-4.0, abs=0.01)
    assert profile.duration(152.0, 12.0) == pytest.approx(2.0, abs=0.01)
    assert profile.duration(-15.0, 15.0) == pytest.approx(1.0)
    whole = profile.duration(0.0, 230.0)
    assert whole == pytest.approx(sum(profile.duration(s, 23.0) for s in np.arange(10) * 23.0))


def test_a_speed_is_allowed_where_no_curve_comes() -> None:
    profile = RoadMap(BEND).speed_profiles(MODEL)["round"]
    assert profile.allows(15.0, 0.0, 50.0)
    assert not profile.allows(15.0, 0.0, 150.0)
    assert profile.allows(15.0, 180.0, 500.0)


@given(st.floats(0.0, 16.0), st.floats(-5.0, 220.0))
def test_a_speed_is_free_until_the_profile_is_slower(speed: float, place: float) -> None:
    room = min(PROFILE.free(speed, place), 300.0)
    assert not room or all(PROFILE.reference(s) >= speed for s in np.linspace(place, place + room, 200).tolist())
    if PROFILE.free(speed, place) < np.inf:
        rows = np.arange(place + room, place + room + 3 * PROFILE.spacing, PROFILE.spacing)
        assert min(PROFILE.reference(s) for s in rows.tolist()) < speed + 1e-6
