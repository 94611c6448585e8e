"""What the outputs of a network mean on each family of roads, and which of them are allowed."""

from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes.action import Action
from codriving.methods.learned.layout import JUNCTION, LANES

ACTIONS: dict[str, tuple[Action, ...]] = {
    JUNCTION: (Action.SLOWER, Action.IDLE, Action.FASTER),
    LANES: tuple(Action),
}
"""The action of each output, by family."""


def allowed(family: str, available: Collection[Action]) -> NDArray[np.bool_]:
    """Mark the actions that the road allows.

    Args:
        family: ``junction`` or ``lanes``.

    Returns:
        Whether each output's action is allowed (actions,).
    """
    return np.array([action in available for action in ACTIONS[family]])
