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
    "llm": set(),
    "storage": set(),
    "config": set(),
    "prediction": {"geometry"},
    "scenarios": {"geometry"},
    "metrics": {"geometry"},
    "pictures": {"geometry"},
    "memory": {"llm"},
    "environment": {"scenarios", "geometry"},
    "ordering": set(),
    "reasoning": {"geometry", "prediction", "ordering", "llm"},
    "executors": {"geometry", "prediction", "ordering", "reasoning"},
    "single_vehicle": {"geometry", "prediction", "reasoning"},
    "dilu": {"prediction", "reasoning", "llm", "memory", "single_vehicle"},
    "methods": {
        "geometry",
        "prediction",
        "llm",
        "ordering",
        "reasoning",
        "executors",
        "learning",
        "memory",
        "single_vehicle",
        "dilu",
    },
    "learning": {"geometry", "reasoning"},
    "episodes": set(),
    "reports": {"metrics", "storage", "memory"},
    "experiment": {"episodes", "metrics", "storage", "config", "reports", "pictures", "memory"},
    "envs": {"geometry", "scenarios", "environment", "reasoning", "config", "pictures"},
    "training": {
        "geometry",
        "reasoning",
        "learning",
        "envs",
        "config",
        "storage",
        "methods",
        "single_vehicle",
        "prediction",
        "llm",
    },
    "cli": {"config", "experiment", "reports", "storage", "training"},
    "__main__": {"cli"},
    "__init__": {"experiment", "envs"},
}

DOORS = {
    "highway_env": "environment",
    "gymnasium": "envs",
    "pettingzoo": "envs",
    "litellm": "llm",
    "faiss": "memory",
    "safetensors": "learning",
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
