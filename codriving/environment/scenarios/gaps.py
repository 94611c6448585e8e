"""How far apart vehicles have to start, so that nobody begins with a crash that cannot be avoided."""

import math
from collections.abc import Callable, Hashable, Mapping, Sequence

from codriving.datatypes.scene import Start

LENGTH = 5.0
"""Vehicle length [m]."""

Spot = Callable[[Start], tuple[Hashable, float]]
"""Maps a start to the lane that it stands on, by any name, and its place along it [m]."""


def braking_gap(follower: float, leader: float) -> float:
    """Smallest bumper gap at which a follower can still brake behind its leader.

    Args:
        follower: Speed of the vehicle behind [m/s].
        leader: Speed of the vehicle ahead [m/s].

    Returns:
        2 m plus 0.8 s of travel plus the difference of the stopping distances at 4 m/s2 [m].
    """
    return 2.0 + 0.8 * follower + max(0.0, (follower**2 - leader**2) / 8.0)


def leaves_room(
    start: Start, others: Sequence[Start], spot: Spot, spacing: float, loops: Mapping[Hashable, float] | None = None
) -> bool:
    """Whether a start keeps its distance from the others on the same lane.

    Args:
        spacing: Smallest distance between two centres [m].
        loops: Length of each lane that runs in a circle [m].
    """
    lane, place = spot(start)
    for other in others:
        lane_2, place_2 = spot(other)
        if lane != lane_2:
            continue
        distance = place - place_2
        if loops and lane in loops:
            distance = math.remainder(distance, loops[lane])
        ahead, behind = (start, other) if distance > 0 else (other, start)
        distance = abs(distance)
        if distance < max(spacing, LENGTH + braking_gap(behind.speed, ahead.speed)):
            return False
    return True


def room_on_lane(length: float, slowest: float, spacing: float) -> int:
    """Largest number of vehicles that can start on one lane, even if all draws fall as they should.

    Args:
        length: Length of the start interval [m].
        slowest: Lowest start speed [m/s].
        spacing: Smallest distance between two centres [m].
    """
    return 1 + math.floor(length / max(spacing, LENGTH + braking_gap(slowest, slowest)))
