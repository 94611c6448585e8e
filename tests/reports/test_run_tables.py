"""All tables of a run: files and frames."""

import math
from collections.abc import Callable
from pathlib import Path

from codriving.datatypes.outcome import Ending
from codriving.datatypes.record import EpisodeRecord
from codriving.reports.paper import Paper
from codriving.reports.run_tables import run_tables, write_tables


def test_the_files_are_written_with_one_row_an_episode_and_one_a_cell(
    make: Callable[..., EpisodeRecord], tmp_path: Path
) -> None:
    cells = [[make(0), make(1)], [make(0, variant="no_negotiation")]]
    write_tables(run_tables(cells, Paper()), tmp_path)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["episodes.csv", "summary.csv", "summary.md"]
    assert (tmp_path / "episodes.csv").read_text().count("\n") == 4
    assert (tmp_path / "summary.csv").read_text().count("\n") == 3


def test_frames_hold_numbers_and_nan_where_nothing_is_defined(make: Callable[..., EpisodeRecord]) -> None:
    tables = run_tables([[make(0, velocities=(7.0,)), make(1, Ending.ERROR)]], Paper())
    episodes, summary = tables.episodes.frame(), tables.summary.frame()
    assert list(episodes["seed"]) == [0, 1]
    assert episodes["velocity_mean"][0] == 7.0
    assert math.isnan(episodes["velocity_mean"][1])
    assert episodes["pet_mean"].dtype == float
    assert summary["success_rate"][0] == 1.0
    assert episodes["outcome"][1] == "error"
