"""What is to be run: cells, seeds and where to, worked out before anything is driven."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.config.show import show
from codriving.config.validate import validate
from codriving.episodes.launcher import Launcher
from codriving.experiment.cells import Cell, distinct, make_cell
from codriving.experiment.objects import modules_to_preload
from codriving.storage.redaction import redact


@dataclass(frozen=True)
class Plan:
    """A run that can be started.

    Attributes:
        cells: Rows of the table, in its order.
        first_seed: Seed of the first episode of each cell.
        episodes: Episodes of each cell.
        launcher: Where episodes are driven.
        workers: Number of processes, or ``auto``.
        output: Folder of all experiments.
        experiment: Name of the experiment.
        run: Name of the run, or None for its time.
        config_text: Resolved config of the first cell as YAML, without secrets.
    """

    cells: tuple[Cell, ...]
    first_seed: int
    episodes: int
    launcher: Launcher
    workers: int | str
    output: Path
    experiment: str
    run: str | None
    config_text: str

    @property
    def seeds(self) -> range:
        """The seeds of every cell."""
        return range(self.first_seed, self.first_seed + self.episodes)

    @property
    def configs(self) -> Mapping[str, Mapping[str, Any]]:
        """Resolved config of each cell, by the name of its folder."""
        return {cell.folder: cell.resolved for cell in self.cells}


def make_plan(variations: Sequence[Sequence[str]], config_dir: Path | None = None) -> Plan:
    """Plan a run with one cell a variation.

    Args:
        variations: The overrides of each cell; they share everything that belongs to the run as a whole.
        config_dir: A folder of the user's own configs.

    Returns:
        The plan.

    Raises:
        ConfigError: If an override, a value or a combination cannot be used.
    """
    configs = [compose(list(overrides), config_dir) for overrides in variations]
    first = configs[0]
    launcher: Launcher = build(first["launcher"], first["plugins"], "launcher")
    if not _has_table(first):
        # The simulator's import takes a second: let it pass while the configs are checked here.
        launcher.prepare(first["workers"], first["episodes"] * len(configs), modules_to_preload(configs))
    for config in configs:
        validate(config)
    return Plan(
        cells=distinct([make_cell(config) for config in configs]),
        first_seed=first["seed"],
        episodes=first["episodes"],
        launcher=launcher,
        workers=first["workers"],
        output=Path(first["output"]),
        experiment=first["experiment"],
        run=first["run"],
        config_text=show(redact(first)),
    )


def _has_table(config: Mapping[str, Any]) -> bool:
    """Whether the run is most likely complete, so that nobody need get ready for it."""
    run = config["run"]
    return run is not None and Path(config["output"], config["experiment"], run, "summary.csv").exists()
