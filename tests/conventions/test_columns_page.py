"""The page on columns has a row for every column that a run prints or writes."""

import ast
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

import pytest
from source import PACKAGE

from codriving.reports.columns import Column
from codriving.reports.comparison import comparison_table
from codriving.reports.episodes import MEMORY, episode_columns, timing_columns
from codriving.reports.filters import filter_table
from codriving.reports.flows import flow_table
from codriving.reports.messages import MESSAGES
from codriving.reports.pairs import PAIRED
from codriving.reports.recordings import score_table
from codriving.reports.regret import above_columns
from codriving.reports.results import ASKED, WHOSE
from codriving.reports.summary import ASKED_COLUMNS, BY_MODEL, BY_MODEL_TEXTS, FALLBACKS, REPEATABLE, summary_table

DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGE, TABLES = (DOCS / "columns.md").read_text(encoding="utf-8"), DOCS / "tables"
ROWS = [[cell.strip() for cell in line.split(" | ")] for line in PAGE.splitlines() if line.startswith("| `")]
NAMES = {name for row in ROWS for name in re.findall(r"`(\w+)`", row[0])}
HEADS = {head for row in ROWS for head in re.findall(r"\*([^*]+)\*", row[1])}

MADE = (summary_table([]), comparison_table([]), flow_table([]), filter_table([]), score_table([]))
FIXED = (*timing_columns(), *episode_columns([]), *MESSAGES, *PAIRED, *above_columns(), MEMORY, REPEATABLE)
OF_MODELS = (*ASKED_COLUMNS, *BY_MODEL, *BY_MODEL_TEXTS, FALLBACKS)
COLUMNS: list[Column[object]] = [*(column for table in MADE for column in table.columns), *FIXED, *OF_MODELS]


def _numbers_and_counters() -> Iterator[str]:
    """Names that metrics and methods give to what they measure and count, read off their source."""
    for file in PACKAGE.rglob("*.py"):
        if file.parts[-2] in ("commands", "reports"):
            continue
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "NamedNumber":
                yield from _texts(node.args[:1])
            elif isinstance(node, ast.Subscript) and getattr(node.value, "id", getattr(node.value, "attr", "")) in (
                "counts",
                "_counts",
            ):
                yield from _texts([node.slice])
            elif isinstance(node, ast.Assign | ast.AugAssign):
                targets = node.targets if isinstance(node, ast.Assign) else [node.target]
                if any(getattr(target, "id", "") in ("counts", "rejected") for target in targets):
                    yield from (
                        t for part in ast.walk(node.value) if isinstance(part, ast.Dict) for t in _texts(part.keys)
                    )


def _texts(nodes: Iterable[ast.expr | None]) -> Iterator[str]:
    yield from (node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str))


# What is counted and has no column: it makes the cost empty, and the seconds of a step.
HIDDEN = {"unpriced_calls", "model_seconds"}
COUNTED = sorted({*_numbers_and_counters()} - HIDDEN)


@pytest.mark.parametrize("name", sorted({c.key for c in COLUMNS if c.csv} | {*ASKED, *WHOSE, *COUNTED}))
def test_column_has_a_row(name: str) -> None:
    assert name in NAMES


@pytest.mark.parametrize("head", sorted({column.head for column in COLUMNS if column.head}))
def test_head_of_a_printed_column_is_in_a_row(head: str) -> None:
    assert head in HEADS


def test_what_metrics_and_methods_count_is_found() -> None:
    assert {"ttc_min", "throughput", "replaced", "reflexes", "worse_off", "messages_rejected"} <= {*COUNTED}


def test_columns_of_tables_that_were_driven_have_rows() -> None:
    heads = [file.read_text(encoding="utf-8").splitlines()[1] for file in TABLES.glob("*.csv")]
    # Those of stress alone are on its page.
    found = [head for head in heads if "success_rate" in head and not head.startswith("axis,")]
    driven = {name for head in found for name in head.split(",")}
    assert "plans_infeasible" in driven
    assert driven - NAMES - {"suite"} == set()  # A swept key


def test_no_column_has_two_rows() -> None:
    named = [name for row in ROWS for name in re.findall(r"`(\w+)`", row[0])]
    assert len(named) == len({*named})
