"""Requests to change lanes: where there is no junction, these are what vehicles are in conflict about."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations

from codriving.datatypes.action import Action


@dataclass(frozen=True, slots=True)
class Request:
    """A CAV's wish to change lanes.

    Attributes:
        incentive: What it and those behind it gain (MOBIL) [m/s2]; inf if its route asks for the change.
    """

    ego: str
    action: Action
    incentive: float
    since: float  # Simulated time at which it first asked [s]
    excludes: frozenset[str] = frozenset()


def in_order(requests: Iterable[Request]) -> frozenset[str]:
    """Grant one request after another if it overlaps with none that has been granted."""
    granted: set[str] = set()
    for request in requests:
        if not granted & request.excludes:
            granted.add(request.ego)
    return frozenset(granted)


def best_subset(requests: Sequence[Request]) -> frozenset[str]:
    """Grant the requests that do not overlap and gain most together."""
    bounded = sorted(requests, key=lambda r: (-min(r.incentive, 1e6), r.since, r.ego))[:12]
    best: tuple[float, tuple[str, ...]] = (0.0, ())
    for size in range(1, len(bounded) + 1):
        for chosen in combinations(bounded, size):
            names = {r.ego for r in chosen}
            if any(r.excludes & names for r in chosen):
                continue
            gain = sum(min(r.incentive, 1e6) for r in chosen)
            if gain > best[0] + 1e-9:
                best = gain, tuple(sorted(names))
    return frozenset(best[1])
