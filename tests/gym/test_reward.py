"""What a CAV is rewarded for."""

from dataclasses import fields, replace
from typing import Any

import pytest

from codriving.datatypes.world import Action, Kind, VehicleState
from codriving.errors import ConfigError
from codriving.gym.reward import CavStep, RewardWeights, reward_weights, rewards

NOTHING = RewardWeights(**{field.name: 0.0 for field in fields(RewardWeights)})
STATE = VehicleState("CAV1", Kind.CAV, 0.0, 0.0, 0.0, 6.0, 0.0, ("a", "b", 0))


def driven(start: float = 6.0, end: float | None = 6.0, action: Action = Action.IDLE, failed: bool = False) -> CavStep:
    after = None if end is None else replace(STATE, speed=end)
    return CavStep(replace(STATE, speed=start), after, action, failed)


def reward(one: CavStep, duration: float = 0.5, top: float = 9.0, **weights: float) -> float:
    (value,) = rewards(replace(NOTHING, **weights), [one], duration, top)
    return value


def test_time_and_speed_count_for_as_long_as_they_last() -> None:
    assert reward(driven(), time=-2.0) == pytest.approx(-1.0)
    assert reward(driven(3.0, 6.0), speed=2.0) == pytest.approx(0.5 * 2.0 * 4.5 / 9.0)
    assert reward(driven(3.0, 6.0), speed=2.0, duration=0.1) == pytest.approx(0.1 * 2.0 * 4.5 / 9.0)


def test_comfort_counts_the_square_of_the_acceleration() -> None:
    assert reward(driven(3.0, 6.0), comfort=-1.0) == pytest.approx(-0.5 * 6.0**2)
    assert reward(driven(6.0, 3.0), comfort=-1.0) == pytest.approx(-0.5 * 6.0**2)
    assert reward(driven(6.0, None), comfort=-1.0) == 0.0


def test_events_count_once() -> None:
    assert reward(driven(end=None), arrival=7.0) == 7.0
    assert reward(driven(), arrival=7.0) == 0.0
    assert reward(driven(failed=True), collision=-7.0) == -7.0
    assert reward(driven(action=Action.LANE_LEFT), lane_change=-7.0) == -7.0
    assert reward(driven(action=Action.LANE_RIGHT), lane_change=-7.0) == -7.0
    assert reward(driven(action=Action.FASTER), lane_change=-7.0) == 0.0


def test_cooperation_shares_the_mean() -> None:
    both = [driven(failed=True), driven()]
    weights = replace(NOTHING, collision=-4.0)
    assert rewards(weights, both, 0.5, 9.0) == [-4.0, 0.0]
    assert rewards(replace(weights, cooperation=0.5), both, 0.5, 9.0) == [-3.0, -1.0]
    assert rewards(replace(weights, cooperation=1.0), both, 0.5, 9.0) == [-2.0, -2.0]
    assert rewards(weights, [], 0.5, 9.0) == []


def test_with_the_defaults_arriving_soon_pays_and_neither_dawdling_nor_crashing_does() -> None:
    """Ten seconds at top speed against ten more at a third of it, and against ten seconds saved by a collision."""
    weights = RewardWeights()
    soon = 20 * rewards(weights, [driven(9.0, 9.0)], 0.5, 9.0)[0] + weights.arrival
    late = soon + 20 * rewards(weights, [driven(3.0, 3.0)], 0.5, 9.0)[0]
    assert soon > late > 0.5
    assert rewards(weights, [driven(0.0, 0.0)], 0.5, 9.0)[0] < 0
    assert weights.collision + soon < 0


def test_weights_can_be_given_by_name() -> None:
    assert reward_weights(None) == RewardWeights()
    assert reward_weights({"arrival": 2}) == replace(RewardWeights(), arrival=2)
    assert reward_weights(NOTHING) is NOTHING


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"arival": 1.0}, "unknown weight reward.arival; weights: arrival, collision, "),
        ({"time": float("nan")}, "reward.time must be a finite number, got nan"),
        ({"time": "1"}, "reward.time must be a finite number, got '1'"),
        ({"time": True}, "got True"),
        ({"cooperation": 1.5}, "reward.cooperation must be 0 to 1, got 1.5"),
        (3.0, "reward must be RewardWeights or a mapping of weights by name, got 3.0"),
    ],
)
def test_wrong_weights_are_refused(given: Any, said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        reward_weights(given)
