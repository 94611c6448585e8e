"""Deliberate changes: what is changed, and that each is a program that can be compiled."""

import ast
from pathlib import Path

import pytest

from tests.mutants.changes import changed, changes

SOURCE = '''"""Text."""

from math import inf

LIMIT = 0.4


def slowest(speeds: list[float], least: float = 0.0) -> float:
    """Return 7."""
    found = [s for s in speeds if s >= least]
    if not found and least < LIMIT:
        return inf
    return min(found) - 2 * LIMIT
'''


def test_each_place_is_changed_in_each_way() -> None:
    found = {f"{c.line} {c.old} -> {c.new}" for c in changes("a.py", SOURCE)}
    assert found >= {
        "5 0.4 -> 0.0",
        "5 0.4 -> 0.8",
        "10 s >= least -> s < least",
        "11 not found and least < LIMIT -> not found or least < LIMIT",
        "11 not found -> found",
        "11 if not found and least < LIMIT -> if False",
        "13 min(found) -> max(found)",
        "13 min(found) - 2 * LIMIT -> min(found) + 2 * LIMIT",
        "13 2 -> 4",
    }


def test_texts_and_types_stay() -> None:
    assert not [c for c in changes("a.py", SOURCE) if c.line in (1, 3, 9)]
    assert {c.old for c in changes("a.py", SOURCE) if c.line == 8} == {"0.0"}


@pytest.mark.parametrize("change", changes("a.py", SOURCE), ids=lambda c: f"{c.line}: {c.old} -> {c.new}")
def test_a_change_changes_one_thing_and_compiles(change: object) -> None:
    tree = changed(SOURCE, change, Path("a.py"))  # type: ignore[arg-type]
    compile(tree, "a.py", "exec")
    before, after = ast.unparse(ast.parse(SOURCE)).splitlines(), ast.unparse(tree).splitlines()
    assert before != after


def test_the_key_of_a_change_does_not_depend_on_lines() -> None:
    moved = [c.key for c in changes("a.py", "\n\n" + SOURCE)]
    assert moved == [c.key for c in changes("a.py", SOURCE)]
