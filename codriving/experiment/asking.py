"""The language models that a run asks: which cell asks which, whether they answer, and what they have cost so far."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any, Protocol

from codriving.config.build import build
from codriving.experiment.cells import Cell
from codriving.experiment.nodes import holds

REPLAY = "replay"
"""The setting of ``llm.cache`` with which no server is asked."""


class Totals(Protocol):
    """What has been used up so far, of all episodes together."""

    @property
    def tokens(self) -> int:
        """Tokens of prompts and answers."""
        ...

    @property
    def cost(self) -> float | None:
        """Money [USD]; None where no price is known."""
        ...


class Spending(Protocol):
    """The account of a client."""

    def totals(self) -> Totals:
        """Give what has been used up; callable from any thread."""
        ...


class Client(Protocol):
    """What all episodes ask through; one for each model and settings."""

    on_retry: Callable[[Any], None]

    @property
    def spending(self) -> Spending:
        """What it has used up."""
        ...

    def preflight(self) -> None:
        """Refuse, with a ModelError that says what to set, a model that cannot be reached."""
        ...


class Model(Protocol):
    """What ``llm`` describes where a language model reasons.

    Attributes:
        cache: ``off``, ``use`` or ``replay``.
    """

    name: str
    max_concurrency: int
    failures_in_a_row: int
    cache: str

    def chat(self) -> Client | None:
        """Give the client, shared by all who have the same settings; None if no model is asked."""
        ...


def model_of(resolved: Mapping[str, Any]) -> Model | None:
    """Find out which language model the method of a cell asks.

    Returns:
        The model; None if the built-in rules reason, or the method does not reason at all.

    Raises:
        ConfigError: If it cannot be built.
    """
    node = resolved.get("llm")
    if node is None or not holds(resolved.get("method"), node):
        return None
    model = build(node, resolved["plugins"], "llm")
    asks = hasattr(model, "max_concurrency") and hasattr(model, "chat") and model.chat() is not None
    found: Model | None = model if asks else None
    return found


class Asked:
    """The models of some cells.

    Raises:
        ConfigError: If a model cannot be built.
    """

    def __init__(self, cells: Iterable[Cell]) -> None:
        found = {cell.folder: model_of(cell.resolved) for cell in cells}
        self.models = {folder: model for folder, model in found.items() if model is not None}
        self.retries = 0
        for client in _clients(self.models.values()):
            client.on_retry = self._count_retry

    @property
    def names(self) -> dict[str, str]:
        """Name of the model that each cell asks, by the name of its folder."""
        return {folder: model.name for folder, model in self.models.items()}

    @property
    def patience(self) -> dict[str, int]:
        """Failures in a row that stop the batch, by the name of the model."""
        return {model.name: model.failures_in_a_row for model in self.models.values()}

    @property
    def concurrency(self) -> int:
        """Episodes that are worth driving side by side."""
        return max((model.max_concurrency for model in self.models.values()), default=1)

    def preflight(self) -> None:
        """Refuse what cannot be reached before anything is driven; whatever is replayed needs no server.

        Raises:
            ModelError: With what to set.
        """
        for client in _clients(model for model in self.models.values() if model.cache != REPLAY):
            client.preflight()

    def usage(self) -> str:
        """Say in a few words what has been used up so far."""
        used = [client.spending.totals() for client in _clients(self.models.values())]
        costs = [u.cost for u in used if u.cost is not None]
        money = f"{sum(costs):.4f} USD" if len(costs) == len(used) else "price unknown"
        return f"{sum(u.tokens for u in used):,} tokens, {money}, {self.retries} retries"

    def _count_retry(self, retry: object) -> None:
        # All requests are sent on one loop, so nobody else counts at the same time.
        self.retries += 1


def _clients(models: Iterable[Model]) -> list[Client]:
    """The clients of some models, each once."""
    clients = {id(client): client for client in (model.chat() for model in models) if client is not None}
    return list(clients.values())
