"""The auction: the vehicle that has waited longest, is nearest and would be there soonest bids most and goes first."""

from collections.abc import Mapping, Sequence

from codriving.datatypes import ApproachingVehicle, Instance
from codriving.errors import require_range
from codriving.reasoning import JointPlanner, Ordering, OrderRule, reasons, repaired, timed

# Speed below which a vehicle waits; no time to the conflict zone is worked out with a smaller one either [m/s].
STANDING = 0.5

WAITED, NEAR, SOON = 0.1, 3.0, 1.0  # What a bid counts: each second of waiting [1/s], nearness [m], and soonness [s]

NEAR_OFFSET, SOON_OFFSET = 2.0, 0.5  # What is added to the distance [m] and to the time [s], so that no bid is infinite


def bid(vehicle: ApproachingVehicle, waited: float) -> float:
    """Return what a vehicle bids for going first."""
    soon = vehicle.distance / max(vehicle.speed, STANDING)
    return WAITED * waited + NEAR / (vehicle.distance + NEAR_OFFSET) + SOON / (soon + SOON_OFFSET)


class Auction(OrderRule):
    """Vehicles go by decreasing bid."""

    name = "coop_game"
    variant = "auction"

    def __init__(self, hysteresis: float) -> None:
        require_range("hysteresis", hysteresis, 0, 10)
        self.hysteresis = hysteresis
        self.reset(0)

    def reset(self, seed: int) -> None:
        """Begin an episode; nothing is remembered from the one before."""
        self._stopped: dict[str, float] = {}
        self._agreed: tuple[str, ...] = ()

    def order(self, instance: Instance, planner: JointPlanner) -> Ordering:
        """Return the vehicles by decreasing bid, as far as what is physically fixed allows."""
        waited = self._wait(instance)
        bids = {name: bid(vehicle, waited[name]) for name, vehicle in instance.vehicles.items()}
        fresh = repaired(instance, sorted(bids, key=lambda name: (-bids[name], name)))
        steady = repaired(instance, overtaken(self._as_before(fresh), bids, self.hysteresis))
        # Where the two agree there is nothing to ask the planner.
        kept = steady != fresh and planner.plan(steady).feasible
        self._agreed = tuple(steady if kept else fresh)

        def reason(one: str, other: str) -> str:
            stands = "went first before and " if kept and bids[one] < bids[other] else ""
            return f"{one} {stands}bids {bids[one]:.2f} against {bids[other]:.2f}"

        why = reasons(instance, self._agreed, reason)
        return Ordering(self._agreed, timed(instance, self._agreed), why, {"kept": int(kept)})

    def _wait(self, instance: Instance) -> dict[str, float]:
        """Return how long each vehicle has been waiting [s]."""
        slow = {name for name, vehicle in instance.vehicles.items() if vehicle.speed < STANDING}
        self._stopped = {name: self._stopped.get(name, instance.time) for name in sorted(slow)}
        return {name: instance.time - self._stopped.get(name, instance.time) for name in instance.vehicles}

    def _as_before(self, fresh: Sequence[str]) -> list[str]:
        """Rank all as in the step before; each newcomer right behind the one that it follows by its bid."""
        ranking = [name for name in self._agreed if name in fresh]
        known = set(ranking)
        for k, name in enumerate(fresh):
            if name not in known:
                ranking.insert(ranking.index(fresh[k - 1]) + 1 if k else 0, name)
        return ranking


def overtaken(ranking: Sequence[str], bids: Mapping[str, float], by: float) -> list[str]:
    """Let a vehicle that bids enough more than the one right before it go first, until none does."""
    order, moved = list(ranking), True
    while moved:
        moved = False
        for k in range(len(order) - 1):
            if bids[order[k + 1]] > bids[order[k]] + by:
                order[k], order[k + 1] = order[k + 1], order[k]
                moved = True
    return order
