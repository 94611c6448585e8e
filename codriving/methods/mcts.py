"""Monte Carlo tree search for the order that costs everybody together least time (Xu et al., 2020)."""

from collections.abc import Mapping, Sequence
from random import Random

from codriving.errors import ConfigError
from codriving.methods.order_search.coded import Coded
from codriving.methods.order_search.searched import SearchedOrder
from codriving.methods.order_search.tree_search import Found, TreeSearch

STRIDE = 1_000_003
"""Seeds of two episodes lie so far apart that their steps never share a seed."""


class MonteCarloTreeSearch(SearchedOrder):
    """Tries orders where good ones have been found.

    Args:
        hysteresis: J that another order must save to be taken, 0 to 10 [s].

    Raises:
        ConfigError: If a value is out of range.
    """

    name = "mcts"

    def __init__(
        self,
        iterations: int = 300,
        exploration: float = 0.5,
        heuristic: float = 0.7,
        hysteresis: float = 0.3,
        evacuation_weight: float = 0.0,
        fairness: Mapping[str, float] | None = None,
    ) -> None:
        if not 1 <= iterations <= 100_000:
            raise ConfigError(f"iterations must be 1 to 100000, got {iterations}")
        if not 0 <= exploration <= 10:
            raise ConfigError(f"exploration must be 0 to 10, got {exploration:g}")
        if not 0 <= heuristic <= 1:
            raise ConfigError(f"heuristic must be 0 to 1, got {heuristic:g}")
        super().__init__(hysteresis, evacuation_weight, fairness)
        self.iterations, self.exploration, self.heuristic = iterations, exploration, heuristic

    def search(self, problem: Coded, seeds: Sequence[Sequence[str]]) -> Found:
        """Search the tree of orders from the seeds on."""
        draw = Random(self.seed * STRIDE + self.calls)
        return TreeSearch(problem, self.exploration, self.heuristic, draw).search(seeds, self.iterations)
