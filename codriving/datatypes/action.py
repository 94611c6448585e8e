"""The five semantic decisions of the paper (Section II, action space)."""

from enum import StrEnum


class Action(StrEnum):
    """A high-level decision that lower-level controllers turn into throttle and steering."""

    SLOWER = "SLOWER"
    IDLE = "IDLE"
    FASTER = "FASTER"
    LANE_LEFT = "LANE_LEFT"
    LANE_RIGHT = "LANE_RIGHT"
