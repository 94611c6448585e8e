"""Records -> tables and figures, from what is stored alone, without the simulator."""

from codriving.reports.above import SceneBounds, with_bounds
from codriving.reports.bounds import BoundRow, print_bounds
from codriving.reports.built_memory import BuiltMemory, print_built
from codriving.reports.columns import Table, table
from codriving.reports.comparison import (
    METHOD_CHOICE,
    Compared,
    Condition,
    ablation_rows,
    ablation_table,
    comparison_rows,
    comparison_table,
    print_comparison,
    print_pairs,
    setting_of,
    with_corrected,
)
from codriving.reports.episode_drawings import (
    LINES,
    draw_endings,
    legend_names,
)
from codriving.reports.episodes import TimedEpisode, cpu_per_decision, timing_columns
from codriving.reports.exam import ExamRow, exam_table, print_exam
from codriving.reports.figures import learning_figure, line_labels, load_figure, plain_settings, saved
from codriving.reports.figures_of_runs import FIGURES, PANELS, DrawnRow, panel_count, rate_figure, run_figures
from codriving.reports.filters import FILTERED, FilterRow, filter_rows, filter_table, print_filters
from codriving.reports.flows import flow_table, flow_tables, print_flows
from codriving.reports.grid import GridRow, against_first, grid
from codriving.reports.learning import LearningRow, learning_rows, learning_table, print_learning
from codriving.reports.load import load_rows, load_table, print_each_load, print_loads
from codriving.reports.models import ModelRow, Repetition, model_rows, model_table, print_models
from codriving.reports.paper import Paper, read_learning, read_paper
from codriving.reports.printed import PrintedTable, markdown_text, print_table
from codriving.reports.profile import profile_figure
from codriving.reports.recordings import ScoredFiles, pet_table, print_scores, score_table
from codriving.reports.results import CellResults, stored_results
from codriving.reports.stress import StressCurve, breaking_table, print_stress, stress_notes, stress_table
from codriving.reports.stress_figure import stress_figure
from codriving.reports.subject import METHODS, REFERENCE, Subject
from codriving.reports.summary import RunTables, run_tables

__all__ = [
    "FIGURES", "FILTERED", "LINES", "METHODS", "METHOD_CHOICE", "PANELS", "REFERENCE", "BoundRow", "BuiltMemory",
    "CellResults", "Compared", "Condition", "DrawnRow", "ExamRow", "FilterRow", "GridRow", "LearningRow", "ModelRow",
    "Paper", "PrintedTable", "Repetition", "RunTables", "SceneBounds", "ScoredFiles", "StressCurve", "Subject",
    "Table", "TimedEpisode", "ablation_rows", "ablation_table", "against_first", "breaking_table", "comparison_rows",
    "comparison_table", "cpu_per_decision", "draw_endings", "exam_table", "filter_rows", "filter_table",
    "flow_table", "flow_tables", "grid", "learning_figure", "learning_rows", "learning_table", "legend_names",
    "line_labels", "load_figure", "load_rows", "load_table", "markdown_text", "model_rows", "model_table",
    "panel_count", "pet_table", "plain_settings", "print_bounds", "print_built", "print_comparison",
    "print_each_load", "print_exam", "print_filters", "print_flows", "print_learning", "print_loads", "print_models",
    "print_pairs", "print_scores", "print_stress", "print_table", "profile_figure", "rate_figure", "read_learning",
    "read_paper", "run_figures", "run_tables", "saved", "score_table", "setting_of", "stored_results",
    "stress_figure", "stress_notes", "stress_table", "table", "timing_columns", "with_bounds", "with_corrected",
]  # fmt: skip
