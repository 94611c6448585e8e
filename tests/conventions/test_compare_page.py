"""The page on comparisons names every table and column, and its commands can be given."""

import re
import shlex
from pathlib import Path

import pytest

from codriving.commands.compare import comparison
from codriving.config.choices import TABLES, taking_part
from codriving.reports.comparison import CPU, comparison_table
from codriving.reports.pairs import AGAINST, PAIRED

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "compare.md").read_text(encoding="utf-8")
COMMANDS = [shlex.split(line, comments=True)[2:] for line in re.findall(r"^ {4}(codriving compare .*)$", PAGE, re.M)]


@pytest.mark.parametrize(
    "name", [*taking_part("all"), *(column.key for column in PAIRED if column.csv), "status", "paper_success_rate"]
)
def test_method_or_column_is_documented(name: str) -> None:
    assert f"`{name}`" in PAGE
    assert name in (*taking_part("all"), *comparison_table([]).keys)


@pytest.mark.parametrize("head", [CPU, AGAINST, "McNemar p"])
def test_head_of_a_printed_column_is_documented(head: str) -> None:
    assert f"| {head} |" in PAGE


def test_there_is_a_section_for_each_table() -> None:
    assert all(f"## `compare {table}`" in PAGE for table in TABLES)


@pytest.mark.parametrize("words", [words for words in COMMANDS if "--config-dir" not in words], ids=" ".join)
def test_its_commands_can_be_given(words: list[str]) -> None:
    table, *overrides = [word for word in words if word != "--bound"]
    assert comparison(table, overrides)
