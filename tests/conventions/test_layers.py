"""Who may import whom: the table of docs/architecture.md, read off the source."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "codriving"

EVERYONE = {"datatypes", "errors"}

MAY_IMPORT = {
    "errors": set[str](),
    "datatypes": set(),
    "geometry": set(),
    "environment": {"geometry"},
    "reasoning": {"geometry"},
    "llm": set(),
    "memory": {"llm"},
    "methods": {"geometry", "reasoning", "memory", "llm"},
    "gym": {"geometry", "environment", "reasoning", "config", "animation"},
    "training": {"geometry", "reasoning", "methods", "gym", "config", "runs", "llm"},
    "metrics": {"geometry"},
    "animation": {"geometry"},
    "runs": set(),
    "reports": {"metrics", "runs", "memory"},
    "config": set(),
    "experiment": {"config", "runs", "reports", "metrics", "memory", "animation"},
    "cli": {"config", "experiment", "training"},
    "scenarios": {"environment", "geometry"},
    "ordering": {"reasoning"},
    "__main__": {"cli"},
    "__init__": {"experiment", "gym"},
}

DOORS = {
    "highway_env": "environment",
    "gymnasium": "gym",
    "pettingzoo": "gym",
    "litellm": "llm",
    "faiss": "memory",
    "safetensors": "methods",
    "torch": "training",
    "stable_baselines3": "training",
    "hydra": "config",
    "omegaconf": "config",
    "typer": "cli",
    "click": None,
}


def modules() -> list[Path]:
    return sorted(PACKAGE.rglob("*.py"))


def room(path: Path) -> str:
    first = path.relative_to(PACKAGE).parts[0]
    return first.removesuffix(".py")


def imported(path: Path) -> Iterator[str]:
    """Yield the full names of everything that a file imports, wherever in it."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: write the full name of what is imported"
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


@pytest.mark.parametrize("path", modules(), ids=lambda path: str(path.relative_to(PACKAGE)))
def test_rooms_import_only_what_they_may(path: Path) -> None:
    here = room(path)
    assert here in MAY_IMPORT, f"{here} is a new room: give it a row in this table and in docs/architecture.md"
    allowed = MAY_IMPORT[here] | EVERYONE | {here}
    for name in imported(path):
        parts = name.split(".")
        if parts[0] == "codriving" and len(parts) > 1 and (PACKAGE / parts[1]).exists():
            assert parts[1] in allowed, f"{here} may not import {name}"
        if parts[0] in DOORS:
            assert here == DOORS[parts[0]], f"only {DOORS[parts[0]]} may import {parts[0]}"


def test_errors_and_datatypes_stand_on_nothing() -> None:
    assert not [name for name in imported(PACKAGE / "errors.py") if name.startswith("codriving")]


def test_no_room_for_odds_and_ends() -> None:
    forbidden = {"utils", "util", "common", "core", "helpers", "misc"}
    assert not [p for p in PACKAGE.rglob("*") if p.stem in forbidden]
