"""The faces of a comparison: what `codriving compare` prints and keeps, and data frames for Python."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from codriving.experiment.compared import FURTHER
from codriving.experiment.comparison import comparison
from codriving.experiment.run import command, drive

if TYPE_CHECKING:
    from pandas import DataFrame


@dataclass(frozen=True)
class Comparison:
    """What a comparison gives to Python.

    Attributes:
        table: The comparison itself, as in ``comparison.csv`` or ``load.csv``.
    """

    table: "DataFrame"
    episodes: "DataFrame"
    summary: "DataFrame"
    folder: Path


def run_comparison(table: str | None, overrides: Sequence[str], config_dir: Path | None = None) -> int:
    """Drive all methods on the same seeds and print how they compare: ``codriving compare``.

    Args:
        table: ``baselines``, ``single-vehicle``, ``all`` or ``load``.
        overrides: ``key=value`` tokens that hold for every cell; ``method=`` adds methods.

    Returns:
        Exit code: 0, 1 if episodes ended in an error, 130 if the user stopped it.

    Raises:
        UserError: If the table, the config or the run folder cannot be used.
    """
    points = comparison(table, overrides, config_dir)
    return command(f"compare {table}", points, overrides, config_dir, FURTHER[str(table)])


def compare_frames(table: str, *overrides: str, config_dir: Path | None = None) -> Comparison:
    """Drive all methods on the same seeds and give the tables as data frames; prints no table.

    Args:
        table: ``baselines``, ``single-vehicle``, ``all`` or ``load``.
        *overrides: ``key=value`` tokens.

    Raises:
        UserError: If the table, the config or the run folder cannot be used.
        KeyboardInterrupt: If the user stops it; finished episodes are kept.
    """
    finished = drive(comparison(table, overrides, config_dir), config_dir, FURTHER[table])
    (own,) = finished.extra.tables
    return Comparison(own.frame(), finished.tables.episodes.frame(), finished.tables.summary.frame(), finished.folder)
