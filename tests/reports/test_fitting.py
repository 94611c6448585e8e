"""Each table within the width of a terminal: no line is longer, no head deeper than two lines, no word broken."""

import io
import re
from collections.abc import Callable
from dataclasses import replace

import pytest

from codriving.datatypes.record import EpisodeRecord
from codriving.reports.paper import Paper
from codriving.reports.printed import CUT, LEFT_OUT, PrintedTable, print_table
from codriving.reports.results import CellResults
from codriving.reports.summary import print_summary
from tests.reports.golden_tables import SCREENS, tables

LONG = "cooperation_with_a_rather_long_name no_intent_sharing_negotiation/independent"
MODELS = ("openai/meta-llama/Llama-3.3-70B-Instruct-Turbo", "anthropic/claude-sonnet-4-5-20250929")


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture(autouse=True)
def _terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TERM", "xterm")


def screen(table: PrintedTable, width: int, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    monkeypatch.setenv("COLUMNS", str(width))
    stream = _Terminal()
    print_table(table, stream)
    return re.sub(r"\x1b\[[0-9;]*m", "", stream.getvalue()).splitlines()


def renamed(table: PrintedTable, old: str, new: str) -> PrintedTable:
    rows = tuple(replace(row, cells=tuple(cell.replace(old, new) for cell in row.cells)) for row in table.rows)
    return replace(table, rows=rows)


def check(table: PrintedTable, width: int, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    lines = screen(table, width, monkeypatch)
    assert max(map(len, lines)) <= width
    cells = " ".join(cell for row in table.rows for cell in row.cells)
    known = {*" ".join([table.title, *table.columns, *table.notes, cells]).split()}
    known |= {part for word in known if len(word) > width // 2 for part in re.findall(r"[^-]+-?", word)}
    body = [line for line in lines if set(line) - {"\u2500"}]
    texts = [word for line in body for word in line.split()]
    said = set(re.findall(r"[^ ,;.]+", f"{LEFT_OUT} {CUT}")) | {"variant", "of"}
    assert [word for word in texts if word not in known and word.rstrip(",;.") not in known | said] == []
    rules = [index for index, line in enumerate(lines) if line and not set(line) - {"\u2500"}]
    if rules:
        assert rules[0] - lines.index("") <= 3, "a blank line, then two lines at most"
    return lines


@pytest.mark.parametrize("width", [80, 100, 132])
def test_every_table_fits(width: int, monkeypatch: pytest.MonkeyPatch) -> None:
    tables()
    assert len(SCREENS) > 10
    for table in SCREENS:
        check(table, width, monkeypatch)
        for long in (LONG, LONG.replace(" ", "_")[:70]):
            check(renamed(table, "codriving full", long), width, monkeypatch)


def test_of_many_rows_the_most_important_columns_stay(
    make: Callable[..., EpisodeRecord], monkeypatch: pytest.MonkeyPatch
) -> None:
    cells = [CellResults([make(0, scenario=s)]) for s in ("intersection", "roundabout", "merge")]
    lines = check(print_summary(cells, Paper()), 80, monkeypatch)
    heads = next(line for line in lines if line.startswith("scenario"))
    assert heads.split() == [
        "scenario",
        "codriving",
        "episodes",
        "success",
        "95",
        "%",
        "interval",
        "[s]",
        "1.5",
        "s",
        "[m/s]",
    ]
    assert any(line.startswith("Left out at this width: collision") for line in lines)


def test_what_is_cut_is_named(make: Callable[..., EpisodeRecord], monkeypatch: pytest.MonkeyPatch) -> None:
    cells = [CellResults([make(0, scenario=s, velocities=(7.0, 9.0))]) for s in ("intersection", "roundabout", "merge")]
    text = " ".join(" ".join(check(print_summary(cells, Paper()), 80, monkeypatch)).split())
    assert "The first value alone is shown of: PET mean / max / min [s], velocity mean / max / min [m/s]." in text


def test_one_row_stands_upright_with_all_of_its_numbers(
    make: Callable[..., EpisodeRecord], monkeypatch: pytest.MonkeyPatch
) -> None:
    counts = {"model_calls": 7, "prompt_tokens": 4000, "completion_tokens": 50, "cost_usd": 0.01, "fallbacks": 0}
    table = print_summary([CellResults([make(0, counts=counts, reasoner=MODELS[0])])], Paper())
    lines = check(table, 80, monkeypatch)
    for head in table.columns[1:]:
        assert any(line.startswith(head) for line in lines)
    assert not any("Left out" in line for line in lines)


def test_what_tells_rows_apart_stays_at_any_width(
    make: Callable[..., EpisodeRecord], monkeypatch: pytest.MonkeyPatch
) -> None:
    cells = [CellResults([make(0, reasoner=model, variant=v)]) for model in MODELS for v in ("full", "no_safety_check")]
    for width in (60, 80, 120):
        text = " ".join(screen(print_summary(cells, Paper()), width, monkeypatch))
        for model in MODELS:
            assert text.count(model) >= 3, "in the title and in two rows"


def test_a_wide_terminal_shows_everything_in_rows(
    make: Callable[..., EpisodeRecord], monkeypatch: pytest.MonkeyPatch
) -> None:
    cells = [CellResults([make(seed)]) for seed in range(3)]
    lines = check(print_summary(cells, Paper()), 200, monkeypatch)
    assert sum(line.startswith("codriving full") for line in lines) == 3
    assert not any("Left out" in line for line in lines)
