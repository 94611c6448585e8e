"""How the features of a learned driver are laid out: which number stands where, and in which unit."""

from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes import Action, Road

VERSION = 1  # Version of the features; weights that were trained on another one are refused

JUNCTION, LANES = "junction", "lanes"
# Kinds of roads: single lanes that meet, and lanes side by side. Each has networks of its own.
FAMILIES = (JUNCTION, LANES)

SLOTS = 4  # Others that there is room for; the most urgent come first

# Units of length, as times at the highest target speed [s]: to leaders and zones, and along the own route. Speeds are
# divided by the highest target speed. The speed law a = K_a (v_r - v) is linear, so in these units a vehicle moves
# alike on every grid of target speeds.
NEAR, FAR = 4.5, 7.0

# Own speed and target speed, way to the shared part of the road and to the goal, turn, and a constant.
EGO = ("speed", "target", "to_entry", "to_goal", "left", "straight", "right", "one")

# A leader (both entries are the gap) or a conflict zone: ways of both to it and of the other out of it. ``there`` is 1.
# Where CAVs share and the road has rules of precedence, it is less in a conflict with a vehicle on a lane of the same
# priority (0.6) or of a higher one (0.2): such human drivers will not give way.
SLOT = ("there", "is_cav", "same_path", "crossing", "own_entry", "other_entry", "other_exit", "speed", "target")

# Next vehicle on the lane beside, ahead or behind: bumper to bumper gap, speed less the own.
SIDE = ("gap", "relative_speed", "there")

# Which lanes can be changed to and are free beside; a change that the route asks for (-1 left, 1 right) and the way
# left for it; offset from the lane that is steered for; gap to who drives behind.
LANE_CHANGE = ("left_allowed", "right_allowed", "left_free", "right_free", "must_side", "must_room", "offset", "rear")

SIDES = ("left_leader", "left_follower", "right_leader", "right_follower")


def feature_names(family: str) -> tuple[str, ...]:
    """Return a name for every number of an observation, in order."""
    names = [f"ego.{name}" for name in EGO]
    names += [f"slot{k}.{name}" for k in range(1, SLOTS + 1) for name in SLOT]
    if family == LANES:
        names += [f"{side}.{name}" for side in SIDES for name in SIDE]
        names += [f"lane.{name}" for name in LANE_CHANGE]
    return tuple(names)


def feature_count(family: str) -> int:
    """Return how many numbers an observation has: 8 + 9 slots, and 12 + 8 more on lanes.

    Args:
        family: ``junction`` or ``lanes``.
    """
    return len(feature_names(family))


def family_of(road: Road) -> str:
    """Return the family of a road that has not been precomputed."""
    return LANES if any(lane.id[2] > 0 for lane in road.lanes) else JUNCTION


FIVE = (Action.SLOWER, Action.IDLE, Action.FASTER, Action.LANE_LEFT, Action.LANE_RIGHT)

# The action of each output, by family.
ACTIONS: dict[str, tuple[Action, ...]] = {JUNCTION: (Action.SLOWER, Action.IDLE, Action.FASTER), LANES: FIVE}


def allowed(family: str, available: Collection[Action]) -> NDArray[np.bool_]:
    """Mark the actions that the road allows.

    Args:
        family: ``junction`` or ``lanes``.

    Returns:
        Whether each output's action is allowed (actions,).
    """
    return np.array([action in available for action in ACTIONS[family]])
