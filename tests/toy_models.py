"""Toy language models and methods that ask them; also a batch of its own: ``toy_models.py OUTPUT SAYS HOLDS``."""

import os
import signal
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from threading import Lock
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

from toy_drive import ToyDeliberation, ToyEnvironment, ToyMethod, toy_scorers

from codriving.commands import run
from codriving.config.build import build
from codriving.datatypes.parts import Method, Model
from codriving.datatypes.world import WorldState
from codriving.experiment import batch
from codriving.experiment.cells import Cell, distinct, folder_name
from codriving.experiment.episode import Labels
from codriving.experiment.launchers import Launcher
from codriving.experiment.objects import model_of
from codriving.experiment.plan import Plan
from codriving.experiment.processes import Processes
from codriving.experiment.worker import Objects

PLUGIN = "toy_models"
EPISODES = 10


@dataclass
class ToyTotals:
    """What was used up."""

    tokens: int = 0
    cost: float | None = 0.0


@dataclass
class ToyClient:
    """Answers at once; goes wrong where the test wants it."""

    does: Callable[[int, int], None] = lambda seed, step: None
    refuses: Exception | None = None
    on_retry: Callable[[Any], None] = lambda retry: None
    preflights: int = 0
    served: str = ""
    never_answered: int = 0
    asked: list[tuple[int, int]] = field(default_factory=list)
    now: int = 0
    most: int = 0
    used: ToyTotals = field(default_factory=ToyTotals)
    lock: Any = field(default_factory=Lock)

    @property
    def spending(self) -> "ToyClient":
        """Its own account."""
        return self

    def totals(self) -> ToyTotals:
        """What was used up."""
        return self.used

    def preflight(self) -> None:
        """Count, and refuse if it is to."""
        self.preflights += 1
        if self.refuses:
            raise self.refuses

    def ask(self, seed: int, step: int) -> None:
        """Answer."""
        with self.lock:
            self.now += 1
            self.most = max(self.most, self.now)
            self.asked.append((seed, step))
            self.used.tokens += 100
            self.used.cost = None if self.used.cost is None else self.used.cost + 0.001
        try:
            self.does(seed, step)
        finally:
            with self.lock:
                self.now -= 1


CLIENTS: dict[str, ToyClient] = {}
"""The client of each model, by its name: what a test changes, the model of a config finds."""


class ToyModel(Model):
    """What ``llm`` describes."""

    def __init__(
        self, name: str, max_concurrency: int = 3, failures_in_a_row: int = 3, cache: str = "off", max_cost: float = 1.0
    ) -> None:
        self.name, self.max_concurrency, self.failures_in_a_row = name, max_concurrency, failures_in_a_row
        self.cache, self.max_cost = cache, max_cost
        self.ask_plain, self.prompts = False, None

    def chat(self) -> ToyClient:
        """The client that all of this name share."""
        return CLIENTS.setdefault(self.name, ToyClient())


class Asking(ToyMethod):
    """Asks before each decision."""

    def __init__(self, llm: Model) -> None:
        super().__init__(reasoner=llm.name)
        self.llm = llm

    def act(self, world: WorldState) -> ToyDeliberation:
        """Ask, then go on."""
        self.llm.chat().ask(self.seed, world.step)
        return super().act(world)


class Computing(ToyMethod):
    """Asks nothing."""

    def __init__(self) -> None:
        super().__init__()


@dataclass(frozen=True)
class BuildAsking:
    """Builds toys by their configs."""

    configs: Mapping[str, Mapping[str, Any]]

    def __call__(self, cell: str) -> Objects:
        """Build them."""
        sys.path.append(str(Path(__file__).parent))
        config = self.configs[cell]
        llm = model_of(config)
        method = build(config["method"], Method, "method", [PLUGIN], {Model: llm})
        return Objects(ToyEnvironment(), method, toy_scorers(config), llm)


def asking_cell(name: str = "gpt", asks: bool = True, **settings: object) -> Cell:
    llm = {"_target_": f"{PLUGIN}.ToyModel", "name": name, **settings}
    method = {"_target_": f"{PLUGIN}.Asking"} if asks else {"_target_": f"{PLUGIN}.Computing"}
    labels = Labels("toy", "asking" if asks else "computing", "full", name if asks else "rules")
    resolved = {"seed": 0, "plugins": [PLUGIN], "llm": llm, "memory": None, "method": method}
    return Cell(folder_name(labels), labels, resolved, "standard", {})


def asking_plan(
    output: Path,
    *cells: Cell,
    episodes: int = EPISODES,
    workers: int | str = "auto",
    launcher: Launcher | None = None,
    name: str | None = "mine",
) -> Plan:
    rows = distinct(cells or (asking_cell(),))
    return Plan(rows, 0, episodes, launcher or Processes(), workers, output, "run", name)


def main(output: Path, says: int, holds: int) -> int:
    """Drive a batch of which three episodes wait in vain for an answer, from seed 4 on.

    Args:
        says: Descriptor of a pipe; one byte is written for each episode that waits.
        holds: Descriptor of a pipe that nothing is ever written to.
    """

    def wait(seed: int, step: int) -> None:
        if seed >= 4:
            os.write(says, b"w")
            # Blocks for ever, as a server does that never answers.
            os.read(holds, 1)

    CLIENTS["gpt"] = ToyClient(wait)
    plan = asking_plan(output)
    run.make_plan = lambda points, config_dir: plan  # type: ignore[assignment]
    batch.BuildObjects = BuildAsking  # type: ignore[assignment,misc]
    return run.run_experiment(["scenario=toy", "run=mine"])


if __name__ == "__main__":
    # What a shell puts into the background ignores SIGINT, and so does all that is started from there.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    # Under its own name, by which the configs call it.
    import toy_models

    sys.exit(toy_models.main(Path(sys.argv[1]), *map(int, sys.argv[2:])))
