"""The conflict coordinator by rules: arrival order, turning yields to straight, who is committed goes (III-C.3)."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Protocol

from codriving.datatypes.order import PassingOrder
from codriving.datatypes.ordering_problem import Instance, Pair
from codriving.geometry.road_map import RoadMap
from codriving.reasoning.ordering.agreement import agreement
from codriving.reasoning.ordering.improve import improve
from codriving.reasoning.ordering.negotiated_reasons import reason_between
from codriving.reasoning.ordering.problem import Conflicts, Problem, ProblemMaker, Scenes
from codriving.reasoning.ordering.schedule import start_time
from codriving.reasoning.prediction.forecast import Forecast

TURN_YIELDS = 1.0
"""A turning vehicle goes before one that goes straight only if it can do so this much earlier [s]."""

KEEPS_TURN = 1.0
"""An order that has been agreed on is changed only if the other one can go this much earlier [s]."""


class Coordinator(Protocol):
    """Decides who goes first: one call for all vehicles."""

    def negotiate(self, scenes: Scenes, conflicts: Conflicts) -> PassingOrder:
        """Return an order without cycles for all conflicts."""
        ...


class RuleCoordinator:
    """Schedules whoever can pass first, again and again, with the traffic rules as handicaps."""

    def __init__(self, road_map: RoadMap, forecast: Forecast, binding: bool) -> None:
        self.problems, self.binding = ProblemMaker(road_map, forecast), binding
        self.previous: PassingOrder | None = None

    def negotiate(self, scenes: Scenes, conflicts: Conflicts) -> PassingOrder:
        """Return an order without cycles for all conflicts."""
        return self.settle(self.problems.pose(scenes, conflicts, 0.0), conflicts, {})

    def settle(self, problem: Problem, conflicts: Conflicts, told: Mapping[Pair, str]) -> PassingOrder:
        """Return an order without cycles in which some pairs are given."""
        instance = replace(problem.instance, before=problem.instance.before | told.keys())
        times = improve(self._list_schedule(instance), instance, self.previous)

        def reason(first: str, second: str) -> str:
            known = told.get((first, second))
            return reason_between(instance.entrants[first], instance.entrants[second]) if known is None else known

        self.previous = agreement(problem, times, conflicts, reason, self.binding)
        return self.previous

    def _list_schedule(self, instance: Instance) -> dict[str, float]:
        """Schedule the vehicle with the smallest start time, handicaps included, until all are scheduled."""
        times: dict[str, float] = {}
        waiting = dict(instance.entrants)
        while waiting:
            held = {second for first, second in instance.before if first in waiting}
            ready = [s for s in waiting.values() if s.id not in held] or list(waiting.values())
            options = []
            for entrant in ready:
                time = start_time(entrant, times, instance.separation)
                handicap = TURN_YIELDS if entrant.turning else 0.0
                if any(
                    self._was_first(k, entrant.id)
                    for k in waiting
                    if (k, entrant.id) in instance.separation and k != entrant.id
                ):
                    handicap += KEEPS_TURN
                options.append((not entrant.committed, time + handicap, entrant.id, time))
            _, _, name, time = min(options)
            times[name] = time
            del waiting[name]
        return times

    def _was_first(self, one: str, other: str) -> bool:
        return self.previous is not None and self.previous.first_of(one, other) == one
