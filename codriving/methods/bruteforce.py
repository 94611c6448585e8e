"""The best passing order of all, by branch and bound: the reference that no search can beat."""

from collections.abc import Sequence

from codriving.datatypes import Instance
from codriving.errors import EpisodeError
from codriving.reasoning import Coded, Found, JointPlanner, Ordering, Prefix, SearchedOrder

MOST = 10  # Vehicles that are ordered at most

LESS = 1e-9  # An order is better only if it saves more than this [s]


class BruteForce(SearchedOrder):
    """Goes through all orders that what is physically fixed allows, except those that cannot be better."""

    name, chosen_as, most_cavs = "bruteforce", "optimal", MOST

    def order(self, instance: Instance, planner: JointPlanner) -> Ordering:
        """Return the best order."""
        if len(instance.vehicles) > MOST:
            raise EpisodeError(
                f"bruteforce orders at most {MOST} vehicles, got {len(instance.vehicles)}; take method=mcts "
                "(order=mcts in the place of order=optimal) or fewer vehicles"
            )
        return super().order(instance, planner)

    def search(self, problem: Coded, seeds: Sequence[Sequence[str]]) -> Found:
        """Go through the tree of orders, the vehicle that can pass first before the others."""
        best = min([problem.run(seed) for seed in seeds], key=problem.cost)
        least, tried = problem.cost(best), 0

        def descend(prefix: Prefix) -> None:
            nonlocal best, least, tried
            if not prefix.waiting:
                tried += 1
                best, least = prefix, problem.cost(prefix)
                return
            options = []
            for k in problem.candidates(prefix):
                longer = prefix.copy()
                problem.place(longer, k)
                bound = problem.bound(longer)
                if bound < least - LESS:
                    options.append((prefix.earliest[k], problem.eta[k], k, bound, longer))
            for *_, bound, longer in sorted(options, key=lambda o: o[:3]):
                if bound < least - LESS:
                    descend(longer)

        descend(problem.root())
        return Found(tuple(problem.named(best.order)), least, tried, True)
