"""Overrides to cells, cells to records, records to the tables that are printed and kept."""

from codriving.experiment.check import run_check
from codriving.experiment.compare import Comparison, compare, compare_frames
from codriving.experiment.run import Results, run_command, run_experiment, run_frames

__all__ = [
    "Comparison",
    "Results",
    "compare",
    "compare_frames",
    "run_check",
    "run_command",
    "run_experiment",
    "run_frames",
]
