"""Overrides to cells, cells to records, records to the tables that are printed and kept."""

from codriving.experiment.run import Results, run_ablation, run_experiment, run_frames

__all__ = ["Results", "run_ablation", "run_experiment", "run_frames"]
