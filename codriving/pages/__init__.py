"""Runs as one page for a browser: tables, figures, and every episode replayed with what was known and decided."""

from codriving.pages.page import report_page
from codriving.pages.paper import Case, PaperPart, find_case, lesson, paper_page, replay_link
from codriving.pages.subject import ReportedEpisode, ReportedRow, ReportedRun

__all__ = [
    "Case", "PaperPart", "ReportedEpisode", "ReportedRow", "ReportedRun", "find_case", "lesson", "paper_page",
    "replay_link", "report_page",
]  # fmt: skip
