"""Instances of the ordering problem made by hand, and a planner that knows nothing but the schedule."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
from hypothesis import strategies as st

from codriving.datatypes.order import ApproachingVehicle, Instance, Pair
from codriving.methods.coop_game.payoff import Goal, Payoff, Scale
from codriving.reasoning.ordering.protocol import JointPlan
from codriving.reasoning.ordering.schedule import schedule, timed

TOP = 9.0
"""Top speed [m/s]."""

SAMPLE, STEPS = 0.2, 60
"""Time between two samples of a plan [s], and their number."""


def vehicle(name: str, eta: float, **more: Any) -> ApproachingVehicle:
    """A vehicle that has a way of 60 m behind its reference point."""
    distance = more.pop("distance", max(eta, 0.0) * TOP)
    remaining = more.pop("remaining", distance + 60.0)
    return ApproachingVehicle(
        name, 100.0, eta, distance=distance, remaining=remaining, **{"stream": name, "speed": TOP, **more}
    )


def instance(
    *vehicles: ApproachingVehicle,
    conflicts: Iterable[Pair] = (),
    before: Iterable[Pair] = (),
    apart: float = 2.0,
    time: float = 0,
) -> Instance:
    """A moment in which pairs in conflict must be some seconds apart."""
    before = set(before)
    pairs = {pair for a, b in (*conflicts, *before) for pair in ((a, b), (b, a))}
    return Instance(time, {e.id: e for e in vehicles}, dict.fromkeys(sorted(pairs), apart), before)


def everybody(names: Sequence[str]) -> list[Pair]:
    """All pairs of some vehicles."""
    return [(a, b) for k, a in enumerate(names) for b in names[:k]]


class Scheduled:
    """A planner by which each vehicle drives evenly up to its scheduled time, and then at top speed."""

    def __init__(self, problem: Instance, works: Callable[[tuple[str, ...]], bool] = lambda order: True) -> None:
        self.problem, self.works = problem, works
        self.asked: list[tuple[str, ...]] = []

    def plan(self, order: Sequence[str]) -> JointPlan:
        """Each vehicle's motion; whether it works is for the test to say."""
        self.asked.append(tuple(order))
        feasible = schedule(self.problem, order) is not None and self.works(tuple(order))
        times = np.arange(STEPS + 1) * SAMPLE
        travels = {}
        for name, passes in timed(self.problem, order).items():
            passes = max(passes, 1e-3)
            distance = self.problem.vehicles[name].distance
            early = times * distance / passes
            travels[name] = np.where(times < passes, early, distance + (times - passes) * TOP)
        return JointPlan(feasible, travels, SAMPLE, int(not feasible))

    def gap_time(self, plan: JointPlan, one: str, other: str) -> float:
        """The time between the two at their reference points."""
        if not self.problem.conflict(one, other):
            return float("inf")
        distances = [self.problem.vehicles[name].distance for name in (one, other)]
        passes = [
            float(np.searchsorted(plan.travels[n], d)) * SAMPLE for n, d in zip((one, other), distances, strict=True)
        ]
        return abs(passes[0] - passes[1])


@st.composite
def problems(draw: st.DrawFn, most: int = 6) -> Instance:
    """An instance with some streams, conflicts between them, and an order along each stream that is fixed."""
    number = draw(st.integers(1, most))
    streams = [f"s{draw(st.integers(0, 3))}" for _ in range(number)]
    etas = draw(st.lists(st.floats(0.5, 12.0), min_size=number, max_size=number))
    turning = draw(st.lists(st.booleans(), min_size=number, max_size=number))
    cars = [
        vehicle(f"v{k}", etas[k], stream=streams[k], turning=turning[k], speed=draw(st.sampled_from([0.0, 4.0, TOP])))
        for k in range(number)
    ]
    meets = {(a, b): draw(st.booleans()) for a in sorted(set(streams)) for b in sorted(set(streams)) if a < b}
    conflicts = [(a.id, b.id) for a in cars for b in cars if a.stream < b.stream and meets[a.stream, b.stream]]
    before = [(a.id, b.id) for a in cars for b in cars if a.stream == b.stream and (a.eta, a.id) < (b.eta, b.id)]
    return instance(*cars, conflicts=conflicts, before=before, apart=draw(st.sampled_from([1.0, 2.5])))


GAME: dict[str, Any] = {
    "objective": "inverse_distance",
    "scale": "turning",
    "levels": None,
    "evaluations": 60,
    "hysteresis": 0.3,
    "rational": False,
    "efficiency": 8.2,
    "comfort": 1.72,
    "safety": 5.7,
    "reference_acceleration": 4.0,
    "risk_time": 1.5,
    "control_radius": 60.0,
}
"""Settings of the cooperative game."""


def payoff(objective: Goal = Goal.INVERSE_DISTANCE, scale: Scale = Scale.TURNING) -> Payoff:
    """What a plan is worth, with the weights of the game."""
    return Payoff(objective, scale, 8.2, 1.72, 5.7, 4.0, 1.5)
