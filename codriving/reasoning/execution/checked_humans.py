"""Human drivers as the safety check and the decision of ``codriving`` take them, for plans of the executor."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from codriving.datatypes import Action, ActionAssessment, Decision, PassingOrder, Situation
from codriving.geometry import Array, Steps, halts_behind
from codriving.reasoning.decision.rules import decide_one
from codriving.reasoning.execution.violations import passes_too_early
from codriving.reasoning.ordering.coordinator import agreement
from codriving.reasoning.ordering.problem import Problem
from codriving.reasoning.ordering.schedule import timed
from codriving.reasoning.perception import Moment
from codriving.reasoning.prediction.expectation import (
    Expected,
    bounds_of,
    expect_human,
    progress_by_action,
    with_guesses,
)
from codriving.reasoning.prediction.rollout import plan_library
from codriving.reasoning.safety.assessment import ThreeLayers
from codriving.reasoning.safety.safety_input import LONGITUDINAL, safety_input


class CheckedHumans:
    """The human drivers of one moment: plans keep behind those who go first, and what is done now has to be safe.

    Args:
        problem: The ordering problem of the moment.
        margin: Time between a human driver's leaving a zone and a CAV's entering it, in plans [s].
    """

    def __init__(self, moment: Moment, problem: Problem, margin: float) -> None:
        self.moment, self._problem = moment, problem
        self._lag = round(margin / moment.forecast.sample)
        self._expected = {
            name: {v.id: expect_human(moment, v) for v in known.values() if not v.is_cav}
            for name, known in moment.vehicles.items()
        }

    def order(self, sequence: Sequence[str], times: Mapping[str, float]) -> PassingOrder:
        """Return who of a CAV and a human driver goes first; a sequence without times is scheduled."""
        instance = self._problem.instance
        if not times:
            named = [name for name in sequence if name in instance.vehicles]
            times = timed(instance, [*named, *(name for name in instance.vehicles if name not in named)])
        return agreement(self.moment, self._problem, times, lambda first, second: "", True)

    def firsts(self, order: PassingOrder) -> tuple[tuple[str, str], ...]:
        """Return the pairs of an order that plans and actions towards human drivers depend on."""
        cavs = self.moment.scenes
        return tuple((p.first, p.second) for p in order.precedences if not (p.first in cavs and p.second in cavs))

    def violations(self, name: str, order: PassingOrder, travels: Array) -> Steps:
        """Return when each plan of a CAV first comes too close to a human driver who is ahead or goes first."""
        moment, n = self.moment, travels.shape[1]
        found: Steps = np.full(len(travels), n)
        for k, (route, place) in enumerate(moment.vehicles[name][name].routes):
            # A lane that it is leaving is minded until its body is off it.
            places = place + travels[:, : moment.forecast.clears if k else n]
            known = self._expected[name]
            for zone, other, after, halts, _ in bounds_of(
                moment, name, name, route, place, known, order, self._lag, k == 0
            ):
                steps = passes_too_early(zone, places, other[: places.shape[1]], after, 0.0)
                found = np.where(steps < places.shape[1], np.minimum(found, steps), found)
                if halts:
                    halted = halts_behind(zone, places, other[: places.shape[1]], halts)
                    found = np.where(halted, found, np.minimum(found, n - 1))
        return found

    def decide(
        self, order: PassingOrder, expected: Mapping[str, tuple[Expected, ...]], lag: int
    ) -> dict[str, tuple[Decision, tuple[ActionAssessment, ...]]]:
        """Decide for each CAV that knows of a human driver, by the rules, among what the safety check leaves.

        CAVs are checked against one another, too: what the check takes from one because of a human driver those behind
        it have not planned for. Without human drivers nothing is taken.

        Args:
            expected: How each CAV means to drive.
            lag: Samples that should lie between one CAV's leaving a zone and the next one's entering it.
        """
        found = {}
        for name, known in self._expected.items():
            if known:
                along = tuple(action for action in self.moment.available[name] if action in LONGITUDINAL)
                moment = replace(self.moment, available={**self.moment.available, name: along})
                given = safety_input(moment, name, order, {**expected, **known}, lag)
                assessed, times = ThreeLayers().assess(given), (0.0,) * len(given.conflicts)
                situation = Situation(given.scene, given.conflicts, order, times, assessed)
                found[name] = decide_one(situation), assessed
        return found

    def guesses(self, name: str, order: PassingOrder, travels: Array, gained: Array) -> dict[Action, float]:
        """Return by how much each action is worth less if human drivers take any of their routes [m].

        Args:
            travels: Distance of each plan of the library over time (plans, n) [m].
            gained: What each is worth; -inf if it does not work (plans,) [m].
        """
        known = self._expected[name]
        if all(len(motions) < 2 for motions in known.values()):
            return {}
        own, plans = self.moment.vehicles[name][name], plan_library(self.moment.forecast.model)
        best = progress_by_action(gained, plans)
        each = with_guesses(self.moment, name, own, travels, gained, known, order, self._lag)
        return {action: each[action] - gain for action, gain in best.items()}
