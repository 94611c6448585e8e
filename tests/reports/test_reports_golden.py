"""Every table of a few made-up episodes, to the byte: CSV, Markdown and what is printed."""

from pathlib import Path

import pytest

from tests.reports.golden_tables import tables

GOLDEN = Path(__file__).with_name("golden")
MADE = tables()


def test_each_table_is_there() -> None:
    assert {path.name for path in GOLDEN.iterdir()} == set(MADE)


@pytest.mark.parametrize("name", sorted(MADE))
def test_table_has_not_changed(name: str) -> None:
    assert MADE[name] == (GOLDEN / name).read_text(encoding="utf-8")
