"""Bounds and expectations of how far each vehicle comes."""

import math
import pickle
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from worlds import Junction

from codriving.datatypes.limits import VehicleLimits
from codriving.datatypes.world import Action, DrivingModel
from codriving.reasoning.prediction.forecast import BRAKE, GO, Forecast, likely_distances
from codriving.reasoning.prediction.rollout import PLANS, Library, rollout

HORIZON = 10.0

MODEL = DrivingModel((0.0, 3.0, 6.0, 9.0), 1.6, 0.1, 0.5, 50.0)
SPEEDS = st.floats(0.0, 9.0)
WAITS = (Action.SLOWER, Action.FASTER)


def test_samples_are_whole_simulation_steps_up_to_the_horizon() -> None:
    forecast = Forecast(MODEL)
    assert forecast.times[0] == 0
    assert forecast.times[-1] == pytest.approx(HORIZON)
    assert forecast.sample / MODEL.step == pytest.approx(round(forecast.sample / MODEL.step))
    assert len(forecast.times) == forecast.steps + 1


def test_travel_is_the_rollout_at_the_samples() -> None:
    forecast = Forecast(MODEL, (WAITS,))
    travel = forecast.travel(4.2, 6.0, [WAITS, BRAKE])
    stride = round(forecast.sample / MODEL.step)
    exact, _ = rollout(MODEL, [4.2], [6.0], (WAITS, BRAKE), forecast.steps * stride)
    assert np.array_equal(travel, exact[0, :, ::stride])


def test_predicting_together_changes_nothing() -> None:
    alone, together = Forecast(MODEL, (WAITS,)), Forecast(MODEL, (WAITS,))
    together.begin_step([(8.0, 9.0, "", 0.0), (4.2, 6.0, "", 0.0), (1.0, 0.0, "", 0.0)])
    assert np.array_equal(alone.travel(4.2, 6.0, [WAITS]), together.travel(4.2, 6.0, [WAITS]))
    assert np.array_equal(alone.reach(8.0, True).most, together.reach(8.0, True).most)
    together.begin_step()
    assert np.array_equal(alone.reach(8.0, True).least, together.reach(8.0, True).least)


@pytest.mark.parametrize("limits", [None, VehicleLimits(4.0, 8.0, 4.0, 3.0, 2.0)])
@pytest.mark.parametrize("is_cav", [False, True])
def test_copy_holds_what_is_still_to_be_worked_out(
    limits: VehicleLimits | None, is_cav: bool, junction: Junction
) -> None:
    forecast = Forecast(replace(MODEL, limits=limits), (WAITS,), junction.road_map)
    where = "south-west", 70.0
    reach = forecast.reach(4.2, is_cav, where)
    copied = pickle.loads(pickle.dumps(forecast)).reach(4.2, is_cav, where)
    for name in ("least", "steady", "most"):
        assert np.array_equal(getattr(copied, name), getattr(reach, name))


def test_library_leaves_its_hash_to_its_process() -> None:
    library = Library([WAITS, GO])
    assert hash(library) == hash((WAITS, GO))
    copied = pickle.loads(pickle.dumps(library))
    assert copied == library
    assert vars(library)
    assert not vars(copied)


@given(SPEEDS, st.booleans())
def test_reach_grows_with_time_and_its_bounds_are_ordered(speed: float, is_cav: bool) -> None:
    reach = Forecast(MODEL).reach(speed, is_cav)
    for distance in (reach.least, reach.steady, reach.most):
        assert distance[0] == 0
        assert (np.diff(distance) >= -1e-9).all()
    assert (reach.least <= reach.steady + 1e-9).all()
    assert (reach.steady <= reach.most + 1e-9).all()


def test_a_library_is_given_whole_and_no_prediction_may_be_written_to() -> None:
    library, forecast, other = Library(PLANS), Forecast(MODEL, (*PLANS, WAITS)), Forecast(MODEL, (WAITS, *PLANS))
    assert hash(library) == hash(tuple(library))
    whole, rows = (each.travel(4.2, 6.0, library) for each in (forecast, other))
    assert np.array_equal(whole, rows)
    assert np.shares_memory(whole, forecast.travel(4.2, 6.0, library))
    with pytest.raises(ValueError, match="read-only"):
        whole[0, 0] = 1.0


def test_what_plans_are_worth_is_forgotten_with_the_step() -> None:
    forecast = Forecast(MODEL)
    forecast.values[forecast.state(4.2, 6.0, ("", 0.0))] = forecast.times
    forecast.begin_step()
    assert forecast.values == {}


FIVE = [action for action in Action if action is not Action.HOLD]
"""Those of a model that is not steady, as in these tests."""


@given(st.sampled_from([0.0, 3.0, 6.0, 9.0]), st.lists(st.sampled_from(FIVE), min_size=1, max_size=5))
def test_no_plan_from_an_allowed_speed_leaves_the_reach(speed: float, plan: list[Action]) -> None:
    forecast = Forecast(MODEL, (tuple(plan),))
    reach = forecast.reach(speed, True)
    (travel,) = forecast.travel(speed, speed, [tuple(plan)])
    assert (reach.least <= travel + 1e-9).all()
    assert (travel <= reach.most + 1e-9).all()


def test_human_drivers_have_wider_bounds_than_cavs() -> None:
    forecast = Forecast(MODEL)
    human, cav = forecast.reach(9.0, False), forecast.reach(9.0, True)
    assert human.least[-1] < cav.least[-1]
    assert human.most[-1] > cav.most[-1]


def test_what_a_driver_is_likely_to_do_is_sampled_like_everything_else() -> None:
    forecast = Forecast(MODEL)
    for ours, theirs in zip(forecast.likely(7.0), likely_distances(7.0 * forecast.times, forecast.times), strict=True):
        assert np.array_equal(ours, theirs)
    least, most = forecast.likely(7.0)
    reach = forecast.reach(7.0, False)
    assert reach.least[-1] < least[-1] < reach.steady[-1] < most[-1] < reach.most[-1]


@given(SPEEDS, st.floats(0.01, 80.0))
def test_time_to_is_the_inverse_of_travel(speed: float, distance: float) -> None:
    forecast = Forecast(MODEL)
    (travel,) = forecast.travel(speed, speed, [GO])
    time = forecast.time_to(distance, travel)
    if time <= forecast.times[-1]:
        assert float(np.interp(time, forecast.times, travel)) == pytest.approx(distance, abs=1e-6)
    else:
        assert travel[-1] < distance
    assert forecast.time_to(distance + 1.0, travel) > time


def test_time_to_goes_on_at_the_last_speed_and_is_infinite_for_who_stands() -> None:
    forecast = Forecast(MODEL)
    (going,), (braking,) = forecast.travel(9.0, 9.0, [GO]), forecast.travel(9.0, 9.0, [BRAKE])
    assert forecast.time_to(900.0, going) == pytest.approx(100.0, rel=1e-3)
    assert math.isinf(forecast.time_to(900.0, braking))
    assert forecast.time_to(0.0, braking) == 0
    assert forecast.time_to(-3.0, braking) == 0
