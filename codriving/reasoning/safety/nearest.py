"""Which allowed action takes the place of one that the safety check removes."""

from collections.abc import Sequence

from codriving.datatypes import Action, ActionAssessment
from codriving.reasoning.safety.safety_input import LONGITUDINAL

STEADY = 0.01  # Changes of the speed up to this are none [m/s]


def nearest(wanted: Action, assessments: Sequence[ActionAssessment], speed: float, target: float) -> tuple[Action, ...]:
    """Return the allowed action that is nearest to one that is wanted, or several of which the least dangerous is.

    The wanted one if it is allowed; else the nearest of those that change the speed in the same direction, nearest by
    the target speed that they set; else the nearest slower one. A lane change keeps speed and lane in mind: it is
    replaced by an action along the lane, as IDLE would be. If all that is left is faster, danger decides.

    Args:
        speed: Speed of the CAV [m/s].
        target: Its target speed [m/s].
    """
    allowed = {a.action: target if a.target is None else a.target for a in assessments if a.safe}
    along = {action: to for action, to in allowed.items() if action in LONGITUDINAL}
    if wanted in allowed:
        return (wanted,)
    (aim,) = (target if a.target is None else a.target for a in assessments if a.action is wanted)
    same = [action for action, to in along.items() if _direction(to - speed) == _direction(aim - speed)]
    options = same or [action for action, to in along.items() if to < aim]
    if options:
        return (min(options, key=lambda action: (abs(along[action] - aim), action is not Action.IDLE)),)
    return tuple(along or allowed)


def _direction(change: float) -> int:
    return (change > STEADY) - (change < -STEADY)
