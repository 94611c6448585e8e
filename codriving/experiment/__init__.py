"""Overrides to cells, cells to records, records to the tables that are printed and kept."""

from codriving.experiment.check import run_check
from codriving.experiment.compare import Comparison, compare, compare_frames
from codriving.experiment.learn import run_learn
from codriving.experiment.memory_build import BUILD
from codriving.experiment.memory_pages import merge_page, search_page, show_page
from codriving.experiment.replay import ReplayOptions, replay
from codriving.experiment.run import ABLATE, RUN, Results, run_command, run_frames

__all__ = [
    "ABLATE", "BUILD", "RUN", "Comparison", "ReplayOptions", "Results", "compare", "compare_frames", "merge_page",
    "replay", "run_check", "run_command", "run_frames", "run_learn", "search_page", "show_page",
]  # fmt: skip
