"""Monte Carlo tree search for the passing order with the least total delay (Xu et al., 2020)."""

from collections.abc import Iterable, Mapping, Sequence
from math import inf, log, sqrt
from random import Random

from codriving.errors import require_range
from codriving.reasoning import Coded, Found, Prefix, SearchedOrder

STRIDE = 1_000_003  # Seeds of two episodes lie so far apart that their steps never share a seed


class MonteCarloTreeSearch(SearchedOrder):
    """Tries orders where good ones have been found."""

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
        require_range("iterations", iterations, 1, 100_000)
        require_range("exploration", exploration, 0, 10)
        require_range("heuristic", heuristic, 0, 1)
        super().__init__(hysteresis, evacuation_weight, fairness)
        self.iterations, self.exploration, self.heuristic = iterations, exploration, heuristic

    def search(self, problem: Coded, seeds: Sequence[Sequence[str]]) -> Found:
        """Search the tree of orders from the seeds on."""
        draw = Random(self.seed * STRIDE + self.calls)
        return TreeSearch(problem, self.exploration, self.heuristic, draw).search(seeds, self.iterations)


class Node:
    """Orders that begin alike.

    A node is where there is a choice; the only vehicle that can go next is placed without one. The first order that was
    tried below a node is kept as its tail, so that it is never tried again.

    Attributes:
        best: J of the best of them [s].
    """

    __slots__ = ("best", "exhausted", "open", "prefix", "tail", "untried", "visits")

    def __init__(self, prefix: Prefix, options: list[int], tail: Sequence[int], best: float) -> None:
        self.prefix, self.untried, self.tail = prefix, options, tail
        self.open: list[Node] = []
        self.visits, self.best, self.exhausted = 1, best, not options


class TreeSearch:
    """One search through all orders that what is physically fixed allows."""

    def __init__(self, problem: Coded, exploration: float, heuristic: float, draw: Random) -> None:
        self.problem, self.exploration, self.heuristic, self.draw = problem, exploration, heuristic, draw
        self.least, self.most = inf, -inf

    def search(self, seeds: Iterable[Sequence[str]], iterations: int) -> Found:
        """Search until the budget is used up or every order has been tried."""
        self.order: list[int] = []
        for seed in seeds:
            whole = self.problem.run(seed)
            self._note(self.problem.cost(whole), whole.order)
        prefix = self.problem.root()
        root = Node(prefix, self._choices(prefix), (), inf)
        root.visits, tried = 0, 0
        if root.exhausted:
            self._note(self.problem.cost(prefix), prefix.order)
        while tried < iterations and not root.exhausted:
            self._iterate(root)
            tried += 1
        return Found(tuple(self.problem.named(self.order)), self.least, tried, root.exhausted)

    def _iterate(self, root: Node) -> None:
        node, path = root, [root]
        while True:
            if node.tail:
                self._unfold(node)
            if node.untried:
                break
            node = self._select(node)
            path.append(node)
        options = node.untried
        child = self._child(node, options.pop(int(self.draw.random() * len(options))))
        if not child.exhausted:
            node.open.append(child)
        for depth in range(len(path) - 1, -1, -1):
            node = path[depth]
            node.visits += 1
            node.best = min(node.best, child.best)
            node.exhausted = not node.open and not node.untried
            if node.exhausted and depth:
                path[depth - 1].open.remove(node)

    def _select(self, node: Node) -> Node:
        """Return the child with the best order below it, the less tried ones with a bonus (UCB on J from 0 to 1)."""
        if len(node.open) == 1:
            return node.open[0]
        most, scale = self.most, 1 / max(self.most - self.least, 1e-9)
        total, weight = log(node.visits), self.exploration
        return max(node.open, key=lambda c: (most - c.best) * scale + weight * sqrt(total / c.visits))

    def _child(self, node: Node, option: int) -> Node:
        """Expand by one choice and complete the order from there."""
        prefix = node.prefix.copy()
        self.problem.place(prefix, option)
        options, whole, tail = self._choices(prefix), prefix, list[int]()
        if options:
            whole, tail = self.problem.complete(prefix, self.heuristic, self.draw.random)
        cost = self.problem.cost(whole)
        self._note(cost, whole.order)
        return Node(prefix, options, tail, cost)

    def _unfold(self, node: Node) -> None:
        """Make the first order that was tried below a node a part of the tree, one choice of it."""
        prefix, option = node.prefix.copy(), node.tail[0]
        self.problem.place(prefix, option)
        node.untried.remove(option)
        child = Node(prefix, self._choices(prefix), node.tail[1:], node.best)
        if not child.exhausted:
            node.open.append(child)
        node.tail = ()

    def _choices(self, prefix: Prefix) -> list[int]:
        """Place vehicles while only one can go next, and return those between which there is a choice."""
        while prefix.waiting:
            options = self.problem.candidates(prefix)
            if len(options) > 1:
                return options
            self.problem.place(prefix, options[0])
        return []

    def _note(self, cost: float, order: list[int]) -> None:
        self.most = max(self.most, cost)
        if cost < self.least:
            self.least, self.order = cost, order
