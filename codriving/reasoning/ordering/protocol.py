"""What an ordering rule is: it is handed an instance, or requests to change lanes, and says who passes first."""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from codriving.datatypes import Action, Instance, OrderOfCavs, Pair


@dataclass(frozen=True, slots=True)
class Request:
    """A CAV's wish to change lanes."""

    ego: str
    action: Action
    incentive: float  # What it and those behind it gain (MOBIL) [m/s2]; inf if its route asks for the change
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
    best: tuple[float, frozenset[str]] = 0.0, frozenset()
    for size in range(1, len(bounded) + 1):
        for chosen in combinations(bounded, size):
            names = frozenset(r.ego for r in chosen)
            if any(r.excludes & names for r in chosen):
                continue
            gain = sum(min(r.incentive, 1e6) for r in chosen)
            if gain > best[0] + 1e-9:
                best = gain, names
    return best[1]


@dataclass(frozen=True, slots=True)
class Ordering:
    """The answer of an ordering rule."""

    sequence: tuple[str, ...]
    times: Mapping[str, float]  # When each is to pass its reference point, in the same order [s]
    reasons: Mapping[Pair, str] = field(default_factory=dict)
    counts: Mapping[str, int] = field(default_factory=dict)
    # Earliest time at which a vehicle may pass its reference point even if its way is free [s]; only of those that the
    # rule holds back for longer than their conflicts do.
    not_before: Mapping[str, float] = field(default_factory=dict)

    def reason(self, first: str, second: str) -> str:
        """Say why one of two CAVs goes before the other one."""
        return self.reasons.get((first, second), f"{first} comes before {second} in the order")


@dataclass(frozen=True, slots=True)
class JointPlan:
    """What all CAVs would do in one order, planned one after another with the exact vehicle model."""

    feasible: bool
    travels: Mapping[str, NDArray[np.float64]]  # Distance of each CAV over time, by id; each (steps + 1,) [m]
    sample: float  # Time between two samples [s]
    stuck: int = 0
    worth: float = 0.0  # What the plans are worth together: roughly the distance within the horizon [m]

    def speed(self, name: str) -> NDArray[np.float64]:
        """Return the speed of a CAV over time (steps + 1,) [m/s]."""
        return np.gradient(self.travels[name], self.sample, edge_order=2)


class JointPlanner(ABC):
    """Plans all CAVs in a given order; the same planner that drives the cars."""

    @abstractmethod
    def plan(self, order: Sequence[str]) -> JointPlan:
        """Return what all CAVs would do."""

    @abstractmethod
    def gap_time(self, plan: JointPlan, one: str, other: str) -> float:
        """Return the time between one vehicle's leaving a shared zone and the other's entering it, the least of all.

        Returns:
            Time [s]; inf if they share no zone or one of them does not come there within the horizon.
        """


class OrderRule(OrderOfCavs, ABC):
    """Chooses the order of an instance, step after step of one episode."""

    name: str = ""
    variant: str = ""
    chosen_as: str = ""  # What ``order=`` of codriving calls it in tables; empty for its name

    def reset(self, seed: int) -> None:
        """Begin an episode; nothing is remembered from the one before."""
        return None

    @abstractmethod
    def order(self, instance: Instance, planner: JointPlanner) -> Ordering:
        """Return the passing order."""

    def grant(self, requests: Sequence[Request]) -> frozenset[str]:
        """Return the CAVs that may change lanes now, by id: those that do not overlap and gain most together."""
        return best_subset(requests)
