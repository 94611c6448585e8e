"""timing.json: what was measured comes back, also from a file of an earlier version."""

from pathlib import Path

import pytest

from codriving.runs.episode_folder import TIMING, Timing, read_timing, timing_of
from codriving.runs.json_files import encode


def test_what_was_measured_comes_back(tmp_path: Path) -> None:
    timing = timing_of(2.5, [0.5, 1.0], [0.25, 0.5])
    assert timing == Timing(2.5, 2, 0.75, 1.0, 0.375, 0.5)
    (tmp_path / TIMING).write_text(encode(timing))
    assert read_timing(tmp_path) == timing


def test_a_file_without_computing_times_keeps_all_that_it_has(tmp_path: Path) -> None:
    (tmp_path / TIMING).write_text('{"seconds": 2.0, "decisions": 1, "decision_mean": 0.5, "decision_max": 0.5}')
    assert read_timing(tmp_path) == Timing(2.0, 1, 0.5, 0.5, None, None)


@pytest.mark.parametrize("text", ["", "[1]", "null", '{"seconds": 2.0}', '{"seconds": "x", "decisions": 1}'])
def test_what_cannot_be_read_is_no_timing(tmp_path: Path, text: str) -> None:
    (tmp_path / TIMING).write_text(text)
    assert read_timing(tmp_path) is None
    assert read_timing(tmp_path / "nowhere") is None
