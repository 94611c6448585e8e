"""A passing order of one's own: the vehicle nearest to its first conflict zone goes first."""

from collections.abc import Sequence

from codriving.ordering import Instance, JointPlanner, Ordering, OrderRule, Request, in_order, repaired, schedule


class NearestFirst(OrderRule):
    """The nearest goes first; within a step of the same distance, the faster one.

    Args:
        step: Distances that differ by less count as the same [m].
    """

    name = "nearest_first"
    variant = ""

    def __init__(self, step: float) -> None:
        self.step = step

    def reset(self, seed: int) -> None:
        """Begin an episode; this rule remembers nothing."""

    def order(self, instance: Instance, planner: JointPlanner) -> Ordering:
        """Order by distance, and keep what is physically fixed."""
        ranked = sorted(instance.vehicles.values(), key=lambda e: (round(e.distance / self.step), -e.speed, e.id))
        sequence = repaired(instance, [vehicle.id for vehicle in ranked])
        times = schedule(instance, sequence) or {name: instance.vehicles[name].eta for name in sequence}
        return Ordering(tuple(sequence), times)

    def grant(self, requests: Sequence[Request]) -> frozenset[str]:
        """Let those change lanes who asked first."""
        return in_order(requests)
