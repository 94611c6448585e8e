"""A wished acceleration becomes one of the three actions along the lane."""

from codriving.datatypes.action import Action
from codriving.reasoning.prediction.forecast import Forecast
from codriving.reasoning.prediction.rollout import Plan, rollout

SPEED_ACTIONS = (Action.SLOWER, Action.IDLE, Action.FASTER)

ONCE: tuple[Plan, ...] = ((Action.SLOWER, Action.IDLE), (Action.IDLE,), (Action.FASTER, Action.IDLE))
"""Each action carried out once."""


def mean_accelerations(forecast: Forecast, speed: float, target: float, window: float) -> tuple[float, float, float]:
    """Return the mean acceleration that SLOWER, IDLE and FASTER lead to, each carried out once [m/s2].

    Args:
        speed: Speed now [m/s].
        target: Target speed now [m/s].
        window: Time over which the mean is taken [s].
    """
    model = forecast.model
    steps = max(1, round(window / model.step))
    _, reached = rollout(model, [speed], [target], ONCE, steps)
    slower, idle, faster = ((reached[0, :, -1] - speed) / (steps * model.step)).tolist()
    return slower, idle, faster


def closest_action(wished: float, means: tuple[float, float, float], hard: float) -> Action:
    """Return the action whose mean acceleration is closest to what is wished.

    Who wishes to brake hard slows down whatever the means are, and who wishes to accelerate never does; of two that
    are equally close, the slower one is taken.

    Args:
        wished: Acceleration that is wished [m/s2].
        means: Mean acceleration of SLOWER, IDLE and FASTER [m/s2].
        hard: Braking beyond which the answer is always SLOWER [m/s2].
    """
    if wished < -hard:
        return Action.SLOWER
    options = [(abs(mean - wished), k) for k, mean in enumerate(means) if k > 0 or wished < 0]
    return SPEED_ACTIONS[min(options)[1]]
