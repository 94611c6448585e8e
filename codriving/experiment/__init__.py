"""Config -> cells -> records -> the tables that are printed and kept; one file a command."""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from codriving.experiment.ablation import ABLATE
    from codriving.experiment.bounds import BoundOptions, run_bound
    from codriving.experiment.check import run_check
    from codriving.experiment.compare import Comparison, compare_frames, comparison_command
    from codriving.experiment.export import ExportOptions, run_export
    from codriving.experiment.join import JoinOptions, run_join
    from codriving.experiment.learn import run_learn
    from codriving.experiment.memory_build import BUILD
    from codriving.experiment.memory_pages import merge_page, search_page, show_page
    from codriving.experiment.replay import ReplayOptions, run_replay
    from codriving.experiment.run import RUN, Results, run_command, run_frames
    from codriving.experiment.score import ScoreOptions, run_score
    from codriving.experiment.stress import stress_command

__all__ = [
    "ABLATE", "BUILD", "RUN", "BoundOptions", "Comparison", "ExportOptions", "JoinOptions", "ReplayOptions", "Results",
    "ScoreOptions", "compare_frames", "comparison_command", "merge_page", "run_bound", "run_check", "run_command",
    "run_export", "run_frames", "run_join", "run_learn", "run_replay", "run_score", "search_page", "show_page",
    "stress_command",
]  # fmt: skip

_FILES = {
    "ablation": ("ABLATE",),
    "bounds": ("BoundOptions", "run_bound"),
    "check": ("run_check",),
    "compare": ("Comparison", "compare_frames", "comparison_command"),
    "export": ("ExportOptions", "run_export"),
    "join": ("JoinOptions", "run_join"),
    "learn": ("run_learn",),
    "memory_build": ("BUILD",),
    "memory_pages": ("merge_page", "search_page", "show_page"),
    "replay": ("ReplayOptions", "run_replay"),
    "run": ("RUN", "Results", "run_command", "run_frames"),
    "score": ("ScoreOptions", "run_score"),
    "stress": ("stress_command",),
}


def __getattr__(name: str) -> object:
    """Import a command with the first use of its name: one command does not wait for what another one needs."""
    for file, names in _FILES.items():
        if name in names:
            return getattr(import_module(f"{__name__}.{file}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
