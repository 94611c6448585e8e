"""Judging effects: what an action did to a conflict, from what came of it."""

from dataclasses import replace

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from remembered import conflict, crossing_way, moment, vehicle, without_conflicts

from codriving.datatypes.experience import Effect, Verdict
from codriving.datatypes.world import Action
from codriving.memory.effect import (
    LESSONS,
    DecisionHistory,
    OwnCollision,
    band,
    effect_of,
    own_change,
    verdict_of,
)

HORIZON = 3.0

ALONG = [Action.SLOWER, Action.IDLE, Action.FASTER]
speeds = st.floats(0.6, 12.0)
places = st.floats(12.0, 60.0)


@settings(deadline=None)
@given(places, places, speeds, speeds, st.sampled_from(ALONG), st.floats(-3, 3))
def test_moving_away_from_a_conflict_is_never_called_intensified(
    mine: float, its: float, mine_speed: float, its_speed: float, action: Action, change: float
) -> None:
    """Whatever widens the difference of the times by the CAV's own doing, without a collision or hard braking."""
    after = mine_speed + change
    assume(0.6 <= after <= 12)
    way = crossing_way(mine, its, [mine_speed, after, after], [its_speed] * 3, action)
    effect = effect_of(way, 0)
    assume(effect.own_change >= 0)
    assert verdict_of(effect, action) is not Verdict.INTENSIFIED


@settings(deadline=None)
@given(places, places, speeds, speeds, speeds)
def test_keeping_the_speed_changes_nothing_whatever_the_other_one_does(
    mine: float, its: float, speed: float, one: float, two: float
) -> None:
    way = crossing_way(mine, its, [speed] * 3, [one, two, two], Action.IDLE)
    assert effect_of(way, 0).own_change == pytest.approx(0.0, abs=1e-6)


@settings(deadline=None)
@given(st.floats(50, 60), st.floats(5, 9), st.floats(2.5, 5), st.booleans(), st.floats(4, 9), st.floats(0.3, 1))
def test_slowing_down_and_accelerating_are_opposite_while_the_order_stays(
    mine: float, speed: float, apart: float, last: bool, its_speed: float, change: float
) -> None:
    its = (mine / speed - (apart if last else -apart)) * its_speed
    slow, fast = (
        effect_of(crossing_way(mine, its, [speed, speed + c], [its_speed] * 2, action), 0).own_change
        for c, action in ((-change, Action.SLOWER), (change, Action.FASTER))
    )
    assert (slow > 0) is last
    assert (fast < 0) is last


def test_accelerating_into_a_worse_band_has_intensified_it() -> None:
    # The CAV would be 2.4 s later than the other one; after the step it is 1.5 s later.
    way = crossing_way(40.0, 24.0, [7.0, 8.5], [7.2, 7.2], Action.FASTER)
    effect = effect_of(way, 0)
    assert band(effect.dttcp_before or 0) == 1
    assert band(effect.dttcp_after or 9) == 0
    assert verdict_of(effect, Action.FASTER) is Verdict.INTENSIFIED


def test_yielding_eases_it() -> None:
    way = crossing_way(40.0, 24.0, [7.0, 5.0], [7.2, 7.2], Action.SLOWER)
    assert verdict_of(effect_of(way, 0), Action.SLOWER) is Verdict.EASED


def test_a_standing_cav_that_keeps_standing_changes_nothing() -> None:
    way = crossing_way(8.0, 20.0, [0.0, 0.0], [8.0, 8.0], Action.IDLE)
    assert effect_of(way, 0).own_change == pytest.approx(0.0)


def test_in_the_zone_nothing_is_widened_or_narrowed() -> None:
    assert own_change(conflict(3.0, 0.0, 5, 5), conflict(0.5, 0.0, 5, 5), 2.5) == 0.0


def test_without_a_conflict_nothing_was_done_to_one() -> None:
    effect = effect_of(without_conflicts(crossing_way(40.0, 24.0, [7.0, 8.5], [7.2] * 2, Action.FASTER)), 0)
    assert effect == Effect()
    assert verdict_of(effect, Action.FASTER) is Verdict.NEUTRAL


@pytest.mark.parametrize(("time", "within"), [(0.4, True), (HORIZON, True), (HORIZON + 0.1, False)])
def test_a_collision_soon_after_is_put_down_to_it(time: float, within: bool) -> None:
    way = crossing_way(20.0, 20.0, [8.0] * 8, [8.0] * 8, Action.FASTER, collision=OwnCollision(time, "CAV2", True))
    effect = effect_of(way, 0)
    assert (effect.collision is not None) is within
    assert verdict_of(effect, Action.FASTER) is (Verdict.INTENSIFIED if within else Verdict.NEUTRAL)


def test_a_vehicle_that_braked_before_the_collision_is_not_to_blame() -> None:
    way = crossing_way(
        20.0, 28.0, [8.0, 5.0, 2.0], [8.0] * 3, Action.SLOWER, collision=OwnCollision(2.0, "CAV2", False)
    )
    brakes = effect_of(replace(way, steps=way.steps), 0)
    late = crossing_way(
        28.0, 20.0, [8.0, 5.0, 2.0], [8.0] * 3, Action.SLOWER, collision=OwnCollision(2.0, "CAV2", False)
    )
    # Ahead of the other one, braking brings them together; behind it, braking keeps them apart.
    assert brakes.to_blame
    assert not effect_of(late, 0).to_blame


@pytest.mark.parametrize("striker", [True, False])
def test_on_one_lane_only_the_vehicle_behind_is_to_blame(striker: bool) -> None:
    way = DecisionHistory(
        tuple(moment(Action.FASTER, 5.0 * k, 10.0) for k in range(4)), 0.5, OwnCollision(1.5, "HDV1", striker)
    )
    assert effect_of(way, 0).to_blame is striker


def test_a_lane_change_before_a_collision_is_what_led_to_it() -> None:
    actions = [Action.IDLE, Action.LANE_LEFT, Action.IDLE, Action.FASTER]
    way = DecisionHistory(
        tuple(moment(a, 5.0 * k, 10.0) for k, a in enumerate(actions)), 0.5, OwnCollision(2.0, "HDV1", True)
    )
    assert [effect_of(way, k).to_blame for k in range(4)] == [False, True, False, False]


def test_cutting_in_so_that_a_vehicle_has_to_brake_hard_has_intensified_it() -> None:
    def behind(x: float, speed: float) -> tuple[object, ...]:
        return (vehicle("HDV1", x, speed),)

    moments = (
        moment(Action.LANE_LEFT, 20.0, 10.0, others=behind(5.0, 12.0)),
        moment(Action.IDLE, 25.0, 10.0, others=behind(11.0, 12.0)),
        moment(Action.IDLE, 30.0, 10.0, others=behind(16.0, 9.0)),
    )
    effect = effect_of(DecisionHistory(moments, 0.5), 0)
    assert effect.forced_braking == pytest.approx(6.0)
    assert verdict_of(effect, Action.LANE_LEFT) is Verdict.INTENSIFIED
    assert verdict_of(effect, Action.IDLE) is Verdict.NEUTRAL


def waiting(other_speed: float, could_go: bool = True, lead_gap: float | None = None) -> DecisionHistory:
    met = (conflict(5.0, 6.0, 0.0, other_speed),)
    moments = tuple(
        moment(Action.IDLE, 0.0, 0.0, met, (vehicle("CAV2", 0.0, other_speed, 9.0),), lead_gap, could_go)
        for _ in range(8)
    )
    return DecisionHistory(moments, 0.5)


def test_waiting_for_a_vehicle_that_does_not_come_is_too_cautious() -> None:
    assert verdict_of(effect_of(waiting(0.0), 0), Action.IDLE) is Verdict.TOO_CAUTIOUS


def test_holding_a_low_speed_is_waiting_too() -> None:
    way = waiting(0.0)
    held = replace(way, steps=tuple(replace(step, action=Action.HOLD) for step in way.steps))
    assert verdict_of(effect_of(held, 0), Action.HOLD) is Verdict.TOO_CAUTIOUS
    fast = replace(held, steps=tuple(replace(s, ego=replace(s.ego, speed=4.0)) for s in held.steps))
    assert not effect_of(fast, 0).needless


@pytest.mark.parametrize("way", [waiting(4.0), waiting(0.0, could_go=False), waiting(0.0, lead_gap=4.0)])
def test_waiting_for_a_vehicle_that_comes_or_because_nothing_else_is_safe_is_not(way: DecisionHistory) -> None:
    assert not effect_of(way, 0).needless


def test_what_happens_after_the_end_of_the_episode_is_not_known() -> None:
    way = waiting(0.0)
    assert not effect_of(replace(way, steps=way.steps[:4]), 0).needless


def test_the_comment_is_the_papers() -> None:
    assert LESSONS[Verdict.INTENSIFIED] == (
        "Your action has intensified the conflict; similar actions should be avoided."
    )
    assert set(LESSONS) == set(Verdict) - {Verdict.NEUTRAL}
