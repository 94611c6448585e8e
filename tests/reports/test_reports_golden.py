"""Every table of a few made-up episodes, to the byte: CSV, Markdown and what is printed."""

from pathlib import Path

import pytest

from tests.reports.golden_tables import tables

GOLDEN = Path(__file__).with_name("golden")


@pytest.fixture(scope="module")
def made() -> dict[str, str]:
    """The tables, made when they are first read, not when tests are collected."""
    return tables()


def test_each_table_is_there(made: dict[str, str]) -> None:
    assert {path.name for path in GOLDEN.iterdir()} == set(made)


@pytest.mark.parametrize("name", sorted(path.name for path in GOLDEN.iterdir()))
def test_table_has_not_changed(name: str, made: dict[str, str]) -> None:
    assert made[name] == (GOLDEN / name).read_text(encoding="utf-8")
