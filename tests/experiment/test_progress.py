"""Progress: a few lines in a pipe, a bar on a terminal."""

import io
import re

import pytest

from codriving.experiment.progress import show_progress


class Terminal(io.StringIO):
    """A stream that is shown to a person."""

    def isatty(self) -> bool:
        """Say so."""
        return True


def test_a_pipe_gets_about_ten_plain_lines() -> None:
    stream = io.StringIO()
    with show_progress({"cell": 25}, stream=stream) as update:
        for done in range(1, 26):
            update("cell", done == 20)
    lines = stream.getvalue().splitlines()
    assert len(lines) == 13
    assert lines[0] == "2 of 25 episodes done, 0 failed"
    assert lines[-1] == "25 of 25 episodes done, 1 failed"
    assert "\x1b" not in stream.getvalue()


def test_a_terminal_gets_a_bar_with_done_failed_and_remaining_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TERM", "xterm")
    stream = Terminal()
    with show_progress({"cell": 2}, stream=stream) as update:
        update("cell", True)
        update("cell", False)
    text = stream.getvalue()
    assert "2/2" in text
    assert "1 failed" in text
    assert "left" in text
    assert "cells" not in text


def test_of_several_cells_those_that_are_complete_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = io.StringIO()
    with show_progress({"a": 2, "b": 1}, stream=stream) as update:
        for cell in ("a", "b", "a"):
            update(cell, False)
    assert [line.partition("failed, ")[2] for line in stream.getvalue().splitlines()] == [
        "0 of 2 cells complete",
        "1 of 2 cells complete",
        "2 of 2 cells complete",
    ]
    monkeypatch.setenv("TERM", "xterm")
    terminal = Terminal()
    with show_progress({"a": 1, "b": 1}, stream=terminal) as update:
        update("b", False)
    assert "1 of 2 cells" in terminal.getvalue()


def test_on_eighty_columns_no_line_is_broken(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "80")
    stream, used = Terminal(), "1,234,567 tokens, price unknown, 12 retries"
    with show_progress({f"cell{k}": 1000 for k in range(28)}, lambda: used, stream) as update:
        update("cell0", False)
    lines = re.split(r"[\r\n]+", re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", stream.getvalue()))
    assert max(map(len, lines)) <= 80
    assert used in [line.strip() for line in lines]
    assert any("1/28000" in line and "0 of 28 cells" in line for line in lines)
