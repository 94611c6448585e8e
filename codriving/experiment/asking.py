"""The language models that a run asks: which cell asks which, whether they answer, and what they have cost so far."""

import sys
from collections.abc import Iterable

from codriving.datatypes import Chat, Model
from codriving.experiment.cells import Cell
from codriving.experiment.objects import model_of

REPLAY = "replay"  # The setting of ``llm.cache`` with which no server is asked


class Asked:
    """The models of some cells whose answers have to be waited for."""

    def __init__(self, cells: Iterable[Cell]) -> None:
        found = {cell.folder: model_of(cell.resolved) for cell in cells}
        self.models = {folder: model for folder, model in found.items() if model and model.waits and model.chat()}
        self.retries = 0
        for client in _clients(self.models.values()):
            client.on_retry, client.on_note = self._tell_retry, announce

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
        """Refuse what cannot be reached before anything is driven; what is replayed needs no server."""
        for client in _clients(model for model in self.models.values() if model.cache != REPLAY):
            client.preflight()

    @property
    def served(self) -> dict[str, str]:
        """What the servers call the models that have answered, for the manifest."""
        return {f"model {client.name}": client.served for client in _clients(self.models.values()) if client.served}

    def complain(self) -> None:
        """Name the models that have given no usable answer at all."""
        for client in _clients(self.models.values()):
            if asked := client.never_answered:
                announce(f"{client.name}: no usable answer to any of {asked} questions; see what codriving check says")

    def fall_silent(self) -> None:
        """Say no more of requests that are still under way when a batch has ended."""
        for client in _clients(self.models.values()):
            client.on_retry = client.on_note = lambda _: None

    def usage(self) -> str:
        """Say in a few words what has been used up so far."""
        used = [client.spending.totals() for client in _clients(self.models.values())]
        costs = [u.cost for u in used if u.cost is not None]
        money = f"{sum(costs):.4f} USD" if len(costs) == len(used) else "price unknown"
        return f"{sum(u.tokens for u in used):,} tokens, {money}, {self.retries} retries"

    def _tell_retry(self, retry: object) -> None:
        # All requests are sent on one loop, so that no two of these run at the same time.
        self.retries += 1
        announce(retry)


def announce(note: object) -> None:
    """Say something about a model beside the results."""
    print(note, file=sys.stderr, flush=True)


def _clients(models: Iterable[Model]) -> list[Chat]:
    """The clients of some models, each once."""
    return list({id(client): client for client in (model.chat() for model in models)}.values())
