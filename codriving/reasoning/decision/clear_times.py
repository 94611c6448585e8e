"""When a conflict zone is expected to be free."""

import numpy as np

from codriving.datatypes.conflict import Conflict
from codriving.reasoning.safety.outlook import Outlook

CAR_LENGTH = 5.0
"""Length of a vehicle [m]."""


def clear_time(outlook: Outlook, c: Conflict) -> float:
    """Return when the other vehicle is expected to have left the CAV's way into a conflict zone.

    Returns:
        Time from now [s]; 0 if the CAV goes first, inf if the other one is not expected to leave within the horizon.
    """
    if outlook.order.first_of(c.ego, c.other) == c.ego:
        return 0.0
    zone = outlook.road_map.zones(*c.routes)[c.zone]
    # Behind a vehicle that merges, the way is free once it is a car length down the common stretch.
    leaves = zone.merge_j + CAR_LENGTH if zone.merge_j is not None else zone.exit_j
    for motion in outlook.expected.get(c.other, ()):
        if motion.route == c.routes[1]:
            gone = motion.places > leaves
            return float(outlook.forecast.times[int(np.argmax(gone))]) if gone.any() else float("inf")
    return 0.0
