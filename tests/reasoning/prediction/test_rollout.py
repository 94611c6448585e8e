"""The closed form is the simulator's rule, step by step."""

from itertools import product

import numpy as np
import pytest
from highway_env.road.road import Road, RoadNetwork
from highway_env.vehicle.controller import MDPVehicle
from hypothesis import given, settings
from hypothesis import strategies as st

from codriving.datatypes.world import Action, DrivingModel
from codriving.reasoning.prediction.rollout import Plan, canonical, rollout, travelled

STEPS = 60

models = st.builds(
    lambda low, spacing, n, gain, step, substeps: DrivingModel(
        tuple(low + spacing * k for k in range(n)), gain, step, step * substeps, 50.0
    ),
    st.sampled_from([0.0, 4.0, 15.0]),
    st.sampled_from([1.0, 2.5, 3.0, 5.0]),
    st.integers(2, 6),
    st.floats(0.5, 3.0),
    st.sampled_from([0.05, 0.1, 0.2]),
    st.integers(1, 10),
)
plans = st.lists(st.sampled_from(list(Action)), min_size=1, max_size=6).map(tuple)
speeds = st.floats(0.0, 35.0)


def step_by_step(model: DrivingModel, v: float, goal: float, plan: Plan) -> tuple[list[float], list[float]]:
    """What highway-env's MDP vehicle does along its lane: a new target at each decision, then Euler's steps."""
    allowed = model.target_speeds
    s, places, reached = 0.0, [0.0], [v]
    for k in range(STEPS):
        if k % model.substeps == 0:
            action = plan[min(k // model.substeps, len(plan) - 1)]
            share = (v - allowed[0]) / (allowed[-1] - allowed[0])
            index = int(np.clip(np.round(share * (len(allowed) - 1)), 0, len(allowed) - 1))
            if action is Action.HOLD:
                goal = v
            if action is Action.FASTER:
                goal = allowed[min(index + 1, len(allowed) - 1)]
            if action is Action.SLOWER:
                goal = allowed[max(index - 1, 0)]
        s += v * model.step
        v += model.speed_gain * (goal - v) * model.step
        places.append(s)
        reached.append(v)
    return places, reached


@settings(max_examples=60, deadline=None)
@given(models, st.lists(st.tuples(speeds, speeds), min_size=1, max_size=3), st.lists(plans, min_size=1, max_size=3))
def test_closed_form_equals_the_loop(model: DrivingModel, states: list[tuple[float, float]], some: list[Plan]) -> None:
    now, targets = zip(*states, strict=True)
    s, v = rollout(model, now, targets, tuple(some), STEPS)
    assert s.shape == v.shape == (len(states), len(some), STEPS + 1)
    for i, (speed, target) in enumerate(states):
        for k, plan in enumerate(some):
            places, reached = step_by_step(model, speed, target, plan)
            np.testing.assert_allclose(s[i, k], places, rtol=0, atol=1e-9)
            np.testing.assert_allclose(v[i, k], reached, rtol=0, atol=1e-9)


def test_horizon_need_not_be_a_whole_number_of_decisions() -> None:
    model = DrivingModel((0.0, 3.0, 6.0), 1.6, 0.1, 0.5, 50.0)
    long, _ = rollout(model, [4.0], [6.0], ((Action.FASTER,),), 20)
    short, _ = rollout(model, [4.0], [6.0], ((Action.FASTER,),), 7)
    assert short.shape == (1, 1, 8)
    assert np.array_equal(short[0, 0], long[0, 0, :8])


def test_a_lane_change_keeps_the_target_speed() -> None:
    model = DrivingModel((0.0, 3.0, 6.0), 1.6, 0.1, 0.5, 50.0)
    s, _ = rollout(model, [4.0], [6.0], ((Action.LANE_LEFT,), (Action.LANE_RIGHT,), (Action.IDLE,)), 20)
    assert np.array_equal(s[0, 0], s[0, 2])
    assert np.array_equal(s[0, 1], s[0, 2])


TAU = 0.6
"""Time in which highway-env's own controller makes up for a missing speed [s]."""


def stock(decisions: float, simulation: float = 15.0) -> DrivingModel:
    """Highway-env's own vehicle with three target speeds."""
    return DrivingModel((0.0, 4.5, 9.0), 1 / TAU, 1 / simulation, 1 / decisions, 50.0)


@pytest.mark.parametrize("speed", [0.0, 3.1, 9.0])
def test_the_vehicle_of_highway_env_itself_does_what_is_predicted(speed: float) -> None:
    model = stock(5.0)
    plans = tuple(product((Action.SLOWER, Action.IDLE, Action.FASTER), repeat=5))
    road = Road(RoadNetwork.straight_road_network(1, length=1000))
    steps = 5 * model.substeps
    goal = MDPVehicle(road, [0.0, 0.0], speed=speed, target_speeds=list(model.target_speeds)).target_speed
    s, v = rollout(model, [speed], [goal], plans, steps)
    for k, plan in enumerate(plans):
        vehicle = MDPVehicle(road, [0.0, 0.0], speed=speed, target_speeds=list(model.target_speeds))
        driven, reached = [0.0], [speed]
        for action in plan:
            vehicle.act(str(action))
            for _ in range(model.substeps):
                vehicle.act()
                vehicle.step(model.step)
                driven.append(vehicle.position[0])
                reached.append(vehicle.speed)
        np.testing.assert_allclose(s[0, k], driven, rtol=0, atol=1e-6)
        np.testing.assert_allclose(v[0, k], reached, rtol=0, atol=1e-6)


@pytest.mark.parametrize(
    ("decisions", "speed", "distance"), [(5.0, 9.0, 7.2), (1.0, 9.0, 9.9), (5.0, 6.0, 3.6), (5.0, 4.5, 2.7)]
)
def test_how_far_it_takes_to_stop(decisions: float, speed: float, distance: float) -> None:
    s, v = rollout(stock(decisions), [speed], [speed], ((Action.SLOWER,),), 150)
    assert v[0, 0, -1] == pytest.approx(0.0, abs=1e-3)
    assert s[0, 0, -1] == pytest.approx(distance, abs=0.05)


def test_how_hard_it_brakes_and_how_long_it_takes_to_start() -> None:
    model = stock(5.0)
    s, v = rollout(model, [9.0, 0.0], [9.0, 0.0], ((Action.SLOWER,), (Action.FASTER,)), 150)
    assert -np.diff(v[0, 0]).min() / model.step == pytest.approx(11.0, abs=0.3)
    fast = int(np.argmax(v[1, 1] >= 8.9))
    assert fast * model.step == pytest.approx(2.8, abs=0.1)
    assert s[1, 1, fast] == pytest.approx(18.0, abs=0.5)


@settings(max_examples=60, deadline=None)
@given(
    models,
    st.lists(st.tuples(st.floats(-1.0, 35.0), speeds), min_size=1, max_size=3),
    st.lists(plans, min_size=1, max_size=3),
    st.integers(1, 30),
    st.integers(1, 7),
)
def test_samples_are_those_of_the_rollout_bit_for_bit(
    model: DrivingModel, states: list[tuple[float, float]], some: list[Plan], samples: int, stride: int
) -> None:
    now, targets = zip(*states, strict=True)
    every, _ = rollout(model, now, targets, tuple(some), samples * stride)
    found = travelled(model, now, targets, tuple(some), samples, stride)
    assert found.flags.c_contiguous
    assert found.tobytes() == every[..., ::stride].tobytes()


@settings(max_examples=60, deadline=None)
@given(models, st.lists(st.tuples(speeds, speeds, plans), min_size=1, max_size=4), st.integers(1, 4))
def test_paired_plans_are_the_diagonal(model: DrivingModel, some: list[tuple[float, float, Plan]], stride: int) -> None:
    now, targets, own = zip(*some, strict=True)
    every, _ = rollout(model, now, targets, own, 20 * stride)
    found = travelled(model, now, targets, own, 20, stride, paired=True)
    assert found.tobytes() == np.array([every[k, k, ::stride] for k in range(len(some))]).tobytes()


@given(models, speeds, speeds, plans)
def test_a_plan_written_shortly_means_the_same(model: DrivingModel, speed: float, target: float, plan: Plan) -> None:
    short = canonical(plan)
    assert len(short) == 1 or short[-1] is not short[-2]
    assert canonical((*plan, plan[-1])) == short
    long, brief = rollout(model, [speed], [target], (plan, short), 40)[0][0]
    assert long.tobytes() == brief.tobytes()
