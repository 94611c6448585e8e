"""A plan of toy episodes, and the command line driven by it: ``python toy_plan.py OUTPUT WORKERS [GATE]``."""

import signal
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

from toy_drive import LABELS, BuildToy

from codriving.commands import run
from codriving.experiment import batch
from codriving.experiment.cells import Cell, distinct, folder_name
from codriving.experiment.plan import Plan
from codriving.experiment.processes import Processes

EPISODES = 10
EMPTY: dict[str, object] = {"seed": 0, "plugins": [], "llm": None, "memory": None, "method": None}


def toy(**settings: Any) -> Callable[[Mapping[str, Mapping[str, Any]]], BuildToy]:
    """What builds the toy."""
    return lambda configs: BuildToy(**settings, configs=configs)


def toy_cell(swept: Mapping[str, str] | None = None, **settings: object) -> Cell:
    return Cell(folder_name(LABELS), LABELS, {**EMPTY, **settings}, "standard", swept or {})


def toy_plan(
    output: Path,
    workers: int = 1,
    name: str | None = "mine",
    cells: tuple[Cell, ...] = (),
    episodes: int = EPISODES,
) -> Plan:
    return Plan(distinct(cells or (toy_cell(),)), 0, episodes, Processes(), workers, output, "run", name)


if __name__ == "__main__":
    # What a shell puts into the background ignores SIGINT, and so does all that is started from there.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    output, workers, *rest = sys.argv[1:]
    gate = Path(rest[0]) if rest else None
    plan = toy_plan(Path(output), int(workers))
    run.make_plan = lambda points, config_dir: plan  # type: ignore[assignment]
    batch.BuildObjects = toy(gate=gate, waits_from=4)  # type: ignore[assignment,misc]
    sys.exit(run.run_experiment(["scenario=toy", "run=mine"]))
