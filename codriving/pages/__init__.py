"""Runs as one page for a browser: tables, figures, every episode replayed; and an episode as a space-time diagram."""

from codriving.pages.page import report_page
from codriving.pages.paper import Case, PaperPart, find_case, lesson, paper_page, replay_link
from codriving.pages.space_time import space_time_figure
from codriving.pages.subject import ReportedEpisode, ReportedRow, ReportedRun

__all__ = [
    "Case", "PaperPart", "ReportedEpisode", "ReportedRow", "ReportedRun", "find_case", "lesson", "paper_page",
    "replay_link", "report_page", "space_time_figure",
]  # fmt: skip
