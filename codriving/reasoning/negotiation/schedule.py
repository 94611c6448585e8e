"""Times at which vehicles could pass their conflict zones, one after another."""

from dataclasses import dataclass, field

import numpy as np

from codriving.geometry.zone import ConflictZone

GAP = 1.0
"""Time between one vehicle's leaving a zone and the next one's entering it [s]."""


@dataclass(slots=True)
class Slot:
    """What a schedule has to know of one CAV.

    Attributes:
        id: Vehicle id.
        reference: Arc length of its first conflict zone [m].
        eta: Earliest time at which it can be there [s]; negative if it is past it.
        committed: Whether it can no longer stop before the zone.
        turning: Whether its route turns.
        leader: Id of the CAV ahead of it on its lane, if any.
        windows: Intervals in which it must not pass the reference point, because of human drivers [s].
    """

    id: str
    reference: float
    eta: float
    committed: bool
    turning: bool
    leader: str | None = None
    windows: list[tuple[float, float]] = field(default_factory=list)


def lag_length(zone: ConflictZone) -> float:
    """Return how much farther along the first vehicle must be than the second, at most, through a zone.

    Args:
        zone: The zone, seen from the first vehicle.

    Returns:
        Largest difference of the two arc lengths at which they still touch [m].
    """
    s_j = np.arange(zone.entry_j, zone.exit_j + 0.25, 0.5)
    front = np.asarray(zone.front(s_j))
    inside = np.isfinite(front)
    return float(np.max(front[inside] - s_j[inside])) if inside.any() else 0.0


def start_time(slot: Slot, earlier: dict[str, float], separation: dict[tuple[str, str], float]) -> float:
    """Return the earliest time at which a vehicle can pass after those already scheduled.

    Args:
        slot: The vehicle.
        earlier: Time of each vehicle already scheduled [s].
        separation: Time that must lie between two vehicles, by (first, second) [s].
    """
    time = max([slot.eta] + [t + separation[k, slot.id] for k, t in earlier.items() if (k, slot.id) in separation])
    moved = True
    while moved:
        moved = False
        for begin, end in slot.windows:
            if begin < time < end:
                time, moved = end, True
    return time
