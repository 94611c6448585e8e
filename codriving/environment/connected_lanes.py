"""Which lanes really continue a lane: by where they lie, not by their number."""

from collections.abc import Sequence

import numpy as np
from highway_env.road.lane import AbstractLane
from highway_env.road.road import LaneIndex, RoadNetwork

JOINT = 0.5
"""Largest distance between the end of a lane and the start of one that continues it [m]."""

BEND = 0.3
"""Largest difference of their headings [rad]."""


def continues(lane: AbstractLane, following: AbstractLane) -> bool:
    """Whether one lane begins where another one ends, in the same direction."""
    gap = np.linalg.norm(lane.position(lane.length, 0) - following.position(0, 0))
    turn = lane.heading_at(lane.length) - following.heading_at(0)
    return bool(gap < JOINT and abs((turn + np.pi) % (2 * np.pi) - np.pi) < BEND)


def connected(network: RoadNetwork, index: LaneIndex, planned: Sequence[str]) -> list[tuple[AbstractLane, float]]:
    """Find the lanes that physically precede and follow a lane.

    Returns:
        Each lane with the offset that turns its arc length into that of the given lane [m].
    """
    start, end, _ = index
    lane = network.get_lane(index)
    branches = network.graph.get(end, {})
    found = []
    for to, lanes in branches.items():
        if not planned or to in planned:
            found += [(other, lane.length) for other in lanes if continues(lane, other)]
    for ends in network.graph.values():
        found += [(other, -other.length) for other in ends.get(start, []) if continues(other, lane)]
    return found
