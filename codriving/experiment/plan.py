"""What is to be run: cells, seeds and where to, worked out before anything is driven."""

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from codriving.config.build import build
from codriving.config.sweep import Point
from codriving.experiment.cells import Cell, make_cell
from codriving.experiment.configs import composed, each_cell, validated
from codriving.experiment.episodes.launcher import Launcher
from codriving.experiment.naming import distinct, repeated
from codriving.experiment.objects import modules_to_preload
from codriving.experiment.remembering import pinned


@dataclass(frozen=True)
class Plan:
    """A run that can be started.

    Attributes:
        workers: Number of processes, or ``auto``.
        run: Name of the run, or None for its time.
    """

    cells: tuple[Cell, ...]
    first_seed: int
    episodes: int
    launcher: Launcher
    workers: int | str
    output: Path
    experiment: str
    run: str | None
    notes: tuple[str, ...] = ()
    render: bool = False

    @property
    def seeds(self) -> range:
        """The seeds of every cell."""
        return range(self.first_seed, self.first_seed + self.episodes)

    @property
    def configs(self) -> Mapping[str, Mapping[str, Any]]:
        """Resolved config of each cell, by the name of its folder."""
        return {cell.folder: cell.resolved for cell in self.cells}


def make_plan(points: Sequence[Point], config_dir: Path | None = None) -> Plan:
    """Plan a run with one cell a point.

    Raises:
        ConfigError: If an override, a value or a combination cannot be used.
    """
    configs = composed(points, config_dir)
    first = configs[0]
    launcher: Launcher = build(first["launcher"], first["plugins"], "launcher")
    if not _is_complete(first, len(configs)):
        # The simulator's import takes a second: let it pass while the configs are checked here.
        launcher.prepare(first["workers"], first["episodes"] * len(configs), modules_to_preload(configs))
    validated(points, configs)
    configs = each_cell(points, configs, pinned)
    pairs = list(zip(configs, points, strict=True))
    cells = each_cell(points, pairs, lambda pair: make_cell(*pair))
    return Plan(
        cells=distinct(cells),
        first_seed=first["seed"],
        episodes=first["episodes"],
        launcher=launcher,
        workers=first["workers"],
        output=Path(first["output"]),
        experiment=first["experiment"],
        run=first["run"],
        notes=repeated(cells),
        render=first["render"],
    )


def _is_complete(config: Mapping[str, Any], cells: int) -> bool:
    """Whether the run is most likely complete, so that nobody need get ready for it."""
    if config["run"] is None:
        return False
    table = Path(config["output"], config["experiment"], config["run"], "episodes.csv")
    try:
        with table.open(encoding="utf-8", newline="") as file:
            rows = sum(1 for _ in csv.reader(file)) - 1
    except (OSError, ValueError, csv.Error):
        return False
    return rows >= int(config["episodes"]) * cells
