"""Config -> cells -> records -> the tables that are printed and kept; one file a command."""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from codriving.commands.ablation import ABLATE
    from codriving.commands.bounds import BoundOptions, run_bound
    from codriving.commands.check import run_check
    from codriving.commands.compare import comparison_command
    from codriving.commands.exam import ExamOptions, run_exam
    from codriving.commands.experiment import run_experiment_file
    from codriving.commands.export import ExportOptions, run_export
    from codriving.commands.figures import FigureOptions, draw_episode, draw_runs, write_figures
    from codriving.commands.join import JoinOptions, run_join
    from codriving.commands.learn import Lessons, run_learn
    from codriving.commands.memory_build import BUILD
    from codriving.commands.memory_pages import merge_page, search_page, show_page
    from codriving.commands.paper import run_paper
    from codriving.commands.replay import ReplayOptions, run_replay
    from codriving.commands.report import ReportOptions, run_report
    from codriving.commands.run import RUN, Command, run_command
    from codriving.commands.score import Scored, ScoreOptions, run_score, score_files
    from codriving.commands.stress import stress_command

__all__ = [
    "ABLATE", "BUILD", "RUN", "BoundOptions", "Command", "ExamOptions", "ExportOptions", "FigureOptions",
    "JoinOptions", "Lessons", "ReplayOptions", "ReportOptions", "ScoreOptions", "Scored", "comparison_command",
    "draw_episode", "draw_runs", "merge_page", "run_bound", "run_check", "run_command", "run_exam",
    "run_experiment_file", "run_export", "run_join", "run_learn", "run_paper", "run_replay", "run_report", "run_score",
    "score_files", "search_page", "show_page", "stress_command", "write_figures",
]  # fmt: skip

_FILES = {
    "ablation": ("ABLATE",),
    "bounds": ("BoundOptions", "run_bound"),
    "check": ("run_check",),
    "compare": ("comparison_command",),
    "exam": ("ExamOptions", "run_exam"),
    "experiment": ("run_experiment_file",),
    "export": ("ExportOptions", "run_export"),
    "figures": ("FigureOptions", "draw_episode", "draw_runs", "write_figures"),
    "join": ("JoinOptions", "run_join"),
    "learn": ("Lessons", "run_learn"),
    "memory_build": ("BUILD",),
    "memory_pages": ("merge_page", "search_page", "show_page"),
    "paper": ("run_paper",),
    "replay": ("ReplayOptions", "run_replay"),
    "report": ("ReportOptions", "run_report"),
    "run": ("RUN", "Command", "run_command"),
    "score": ("ScoreOptions", "Scored", "run_score", "score_files"),
    "stress": ("stress_command",),
}


def __getattr__(name: str) -> object:
    """Import a command with the first use of its name: one command does not wait for what another one needs."""
    for file, names in _FILES.items():
        if name in names:
            return getattr(import_module(f"{__name__}.{file}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
