"""Runs as one page for a browser: tables, figures, and every episode replayed with what was known and decided."""

from codriving.pages.page import report_page
from codriving.pages.subject import ReportedEpisode, ReportedRow, ReportedRun

__all__ = ["ReportedEpisode", "ReportedRow", "ReportedRun", "report_page"]
