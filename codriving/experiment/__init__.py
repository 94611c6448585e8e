"""Overrides to cells, cells to records, records to the tables that are printed and kept."""

from codriving.experiment.check import run_check
from codriving.experiment.compare import Comparison, compare_frames, run_comparison
from codriving.experiment.run import Results, run_ablation, run_experiment, run_frames

__all__ = [
    "Comparison",
    "Results",
    "compare_frames",
    "run_ablation",
    "run_check",
    "run_comparison",
    "run_experiment",
    "run_frames",
]
