"""What must lie between two vehicles that pass the same conflict zone one after the other."""

from functools import lru_cache

import numpy as np

from codriving.geometry.zone import ConflictZone

GAP = 1.0
"""Time between one vehicle's leaving a zone and the next one's entering it [s]."""

FOLLOWS = (7.0, 0.5)
"""Distance [m] at top speed and time [s] between two vehicles of one lane, one behind the other."""


@lru_cache(maxsize=4096)
def lag_length(zone: ConflictZone, seen_from_i: bool = True) -> float:
    """Return how much farther along the first vehicle must be than the second, at most, through a zone.

    Returns:
        Largest difference of the two arc lengths at which they still touch [m].
    """
    begin, end = (zone.entry_j, zone.exit_j) if seen_from_i else (zone.entry_i, zone.exit_i)
    s = np.arange(begin, end + 0.25, 0.5)
    front = np.asarray((zone.over_j if seen_from_i else zone.over_i).highest(s))
    inside = np.isfinite(front)
    return float(np.max(front[inside] - s[inside])) if inside.any() else 0.0
