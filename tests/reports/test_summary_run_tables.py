"""All tables of a run: files and frames."""

import math
from collections.abc import Callable
from pathlib import Path

from codriving.datatypes.record import Ending, EpisodeRecord
from codriving.reports.paper import Paper
from codriving.reports.results import CellResults
from codriving.reports.summary import run_tables


def test_the_files_are_written_with_one_row_an_episode_and_one_a_cell(
    make: Callable[..., EpisodeRecord], tmp_path: Path
) -> None:
    cells = [CellResults([make(0), make(1)]), CellResults([make(0, variant="no_negotiation")])]
    run_tables(cells, Paper()).write(tmp_path)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["episodes.csv", "summary.csv", "summary.md"]
    assert (tmp_path / "episodes.csv").read_text().count("\n") == 4
    assert (tmp_path / "summary.csv").read_text().count("\n") == 3


def test_every_row_of_a_sweep_says_what_it_is_of(make: Callable[..., EpisodeRecord]) -> None:
    swept = [{"scenario.cavs": "4", "cda.own_order": "1"}, {"scenario.cavs": "8", "cda.own_order": "own_view"}]
    tables = run_tables([CellResults([make(0), make(1)], values) for values in swept], Paper(), notes=["told"])
    episodes, summary = tables.episodes.frame(), tables.summary.frame()
    assert list(summary["scenario.cavs"]) == [4, 8]
    assert list(episodes["scenario.cavs"]) == [4, 4, 8, 8]
    assert list(summary["cda.own_order"]) == ["1", "own_view"]
    assert tables.page.columns[1:3] == ("scenario.cavs", "cda.own_order")
    assert tables.page.notes[-1] == "told"


def test_frames_hold_numbers_and_nan_where_nothing_is_defined(make: Callable[..., EpisodeRecord]) -> None:
    tables = run_tables([CellResults([make(0, velocities=(7.0,)), make(1, Ending.ERROR)])], Paper())
    episodes, summary = tables.episodes.frame(), tables.summary.frame()
    assert list(episodes["seed"]) == [0, 1]
    assert episodes["velocity_mean"][0] == 7.0
    assert math.isnan(episodes["velocity_mean"][1])
    assert episodes["pet_mean"].dtype == float
    assert summary["success_rate"][0] == 1.0
    assert episodes["outcome"][1] == "error"
