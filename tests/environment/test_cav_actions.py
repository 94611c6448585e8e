"""FASTER, IDLE and SLOWER do what prediction says, and the controllers follow the paper's laws."""

import math
from collections.abc import Callable
from itertools import product

import numpy as np
import pytest

from codriving.datatypes.limits import VehicleLimits
from codriving.datatypes.road import Lane, Road, Route, Straight, Turn
from codriving.datatypes.world import Action, Kind, Start
from codriving.environment.cav import ConnectedVehicle
from codriving.environment.environment import Environment
from codriving.environment.settings import ControlGains
from codriving.errors import ConfigError, EpisodeError
from codriving.reasoning.prediction.forecast import Forecast
from codriving.reasoning.prediction.rollout import rollout

Build = Callable[..., Environment]

STREET = Road(
    "street",
    (Lane(("a", "b", 0), Straight((0.0, 0.0), (300.0, 0.0))),),
    (Route("along", (("a", "b", 0),), Turn.STRAIGHT, entry=200.0, goal=290.0),),
)
SIDES = (Action.LANE_LEFT, Action.LANE_RIGHT)

PLANS = tuple(product((Action.SLOWER, Action.IDLE, Action.FASTER), repeat=5))


@pytest.mark.parametrize("speed", [0.0, 4.4, 9.0])
def test_actions_do_what_prediction_says(speed: float, by_hand: Build) -> None:
    # Every shorter sequence is the beginning of one of these.
    env = by_hand(starts=[Start("CAV1", Kind.CAV, "along", 20.0, speed)], road=STREET)
    target = env.reset(0).intents["CAV1"].target_speed
    steps = 5 * env.driving_model.substeps
    distances, speeds = rollout(env.driving_model, [speed], [target], PLANS, steps)
    for k, plan in enumerate(PLANS):
        env.reset(0)
        for action in plan:
            env.step({"CAV1": action})
        track = env.trajectory().tracks[0]
        assert np.allclose(track.x - 20.0, distances[0, k], rtol=0, atol=1e-6)
        assert np.allclose(track.speed, speeds[0, k], rtol=0, atol=1e-6)
        assert track.y == pytest.approx(0.0)


@pytest.mark.parametrize("speed", [0.0, 12.0, 27.0])
def test_actions_do_what_prediction_says_at_the_limits(speed: float, by_hand: Build) -> None:
    speeds = (0.0, 10.0, 20.0, 30.0)
    limits = VehicleLimits(4.0, 8.0, 4.0, 3.0, 2.4)
    start = Start("CAV1", Kind.CAV, "along", 20.0, speed)
    env = by_hand(starts=[start], road=STREET, target_speeds=speeds, limits=limits)
    target = env.reset(0).intents["CAV1"].target_speed
    distances, reached = rollout(env.driving_model, [speed], [target], PLANS, 5 * env.driving_model.substeps)
    pedals = np.diff(reached[0], axis=1) / 0.1
    assert pedals.max() == pytest.approx(4.0)
    assert pedals.min() == pytest.approx(-8.0) or speed == 0.0
    for k, plan in enumerate(PLANS):
        env.reset(0)
        for action in plan:
            env.step({"CAV1": action})
        track = env.trajectory().tracks[0]
        assert np.allclose(track.x - 20.0, distances[0, k], rtol=0, atol=1e-9)
        assert np.allclose(track.speed, reached[0, k], rtol=0, atol=1e-9)


HOLDING = [(a, Action.HOLD, b, Action.HOLD) for a in Action for b in Action if not {a, b} & set(SIDES)]


@pytest.mark.parametrize("limits", [None, VehicleLimits(4.0, 8.0, 4.0, 3.0, 2.4)])
@pytest.mark.parametrize("speed", [0.0, 4.4, 17.3, 27.0])
def test_hold_keeps_the_speed_as_prediction_says(speed: float, limits: VehicleLimits | None, by_hand: Build) -> None:
    speeds = (0.0, 10.0, 20.0, 30.0)
    start = Start("CAV1", Kind.CAV, "along", 20.0, speed)
    env = by_hand(starts=[start], road=STREET, target_speeds=speeds, limits=limits, steady=True)
    target, steps = env.reset(0).intents["CAV1"].target_speed, 4 * env.driving_model.substeps
    forecast = Forecast(env.driving_model, HOLDING)
    travels = forecast.travel(speed, target, HOLDING)
    distances, reached = rollout(env.driving_model, [speed], [target], tuple(HOLDING), steps)
    for k, plan in enumerate(HOLDING):
        env.reset(0)
        for action in plan:
            env.step({"CAV1": action})
        track = env.trajectory().tracks[0]
        assert np.allclose(track.x - 20.0, distances[0, k], rtol=0, atol=1e-9)
        assert np.allclose(track.speed, reached[0, k], rtol=0, atol=1e-9)
        # From the last decision on the speed is kept, and the plan goes on like that.
        assert np.allclose(track.speed[-6:], track.speed[-6], rtol=0, atol=1e-9)
        assert np.allclose(travels[k, : steps // 2 + 1], distances[0, k, ::2], rtol=0, atol=1e-9)


def test_hold_is_an_action_only_where_the_setting_is_on(by_hand: Build) -> None:
    start = Start("CAV1", Kind.CAV, "along", 20.0, 4.4)
    env, steady = (by_hand(starts=[start], road=STREET, steady=steady) for steady in (False, True))
    assert env.reset(0).available["CAV1"] == (Action.SLOWER, Action.IDLE, Action.FASTER)
    assert steady.reset(0).available["CAV1"] == (Action.SLOWER, Action.IDLE, Action.HOLD, Action.FASTER)
    assert steady.step({"CAV1": Action.HOLD}).intents["CAV1"].target_speed == 4.4
    with pytest.raises(EpisodeError, match="CAV1 cannot do HOLD here; it can do SLOWER, IDLE, FASTER"):
        env.step({"CAV1": Action.HOLD})


def test_acceleration_is_proportional_to_the_missing_speed(by_hand: Build) -> None:
    env = by_hand(starts=[Start("CAV1", Kind.CAV, "along", 20.0, 4.0)], road=STREET)
    env.reset(0)
    env.step({"CAV1": Action.FASTER})
    track = env.trajectory().tracks[0]
    assert track.acceleration[1:] == pytest.approx(1.6 * (6.0 - track.speed[:-1]))
    assert track.speed[1:] == pytest.approx(track.speed[:-1] + track.acceleration[1:] * 0.1)


@pytest.mark.parametrize("delta", [-0.4, -0.05, 0.0, 0.2, 0.9])
def test_bicycle_model(delta: float, by_hand: Build) -> None:
    env = by_hand(starts=[Start("CAV1", Kind.CAV, "along", 20.0, 8.0)], road=STREET)
    env.reset(0)
    vehicle = env._traffic.vehicles[0]
    vehicle.heading, vehicle.action = 0.3, {"steering": delta, "acceleration": 1.5}
    vehicle.step(0.1)
    beta = math.atan(math.tan(delta) / 2)
    assert vehicle.position[0] == pytest.approx(20.0 + 0.8 * math.cos(0.3 + beta))
    assert vehicle.position[1] == pytest.approx(0.8 * math.sin(0.3 + beta))
    assert vehicle.heading == pytest.approx(0.3 + 0.8 * math.sin(beta) / 2.5)
    assert vehicle.speed == pytest.approx(8.15)


def test_steering_follows_the_heading_law(by_hand: Build) -> None:
    env = by_hand(starts=[Start("CAV1", Kind.CAV, "along", 20.0, 8.0)], road=STREET)
    env.reset(0)
    vehicle = env._traffic.vehicles[0]
    vehicle.position[1], vehicle.heading = 0.6, 0.1
    wanted = math.asin(-(1 / 0.6) * 0.6 / 8.0)
    slip = math.asin(5.0 * (wanted - 0.1) * 5.0 / (2 * 8.0))
    steering = vehicle.steering_control(vehicle.target_lane_index)
    assert steering == pytest.approx(math.atan(2 * math.tan(slip)))


def test_gains_are_those_of_the_settings(by_hand: Build) -> None:
    env = by_hand(starts=[Start("CAV1", Kind.CAV, "along", 20.0, 8.0)], road=STREET)
    env.reset(0)
    vehicle = env._traffic.vehicles[0]
    assert (vehicle.KP_A, vehicle.KP_HEADING, vehicle.KP_LATERAL) == (1.6, 5.0, 1 / 0.6)
    assert pytest.approx(1 / 0.6) == ConnectedVehicle.KP_A, "the class keeps what highway-env gave it"


@pytest.mark.parametrize(
    ("gains", "message"),
    [
        ((0.0, 5.0, 1.0), "control.speed must be above 0 and at most 5 1/s, got 0"),
        ((1.6, 50.0, 1.0), "control.heading must be above 0 and at most 10 1/s, got 50"),
        ((1.6, 5.0, math.nan), "control.lateral must be above 0 and at most 5 1/s, got nan"),
    ],
)
def test_gains_out_of_range_are_refused(gains: tuple[float, float, float], message: str) -> None:
    with pytest.raises(ConfigError, match=message):
        ControlGains(*gains)
