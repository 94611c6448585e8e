"""What a room shows is written down, in order, and exists."""

import importlib
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "codriving"
ROOMS = ["codriving", *(f"codriving.{path.parent.name}" for path in sorted(PACKAGE.glob("*/__init__.py")))]


@pytest.mark.parametrize("name", ROOMS)
def test_public_names_are_sorted_and_exist(name: str) -> None:
    room = importlib.import_module(name)
    assert room.__doc__, f"{name} needs a sentence on its idea"
    names = getattr(room, "__all__", [])
    assert names == sorted(names)
    assert all(hasattr(room, public) for public in names)


def test_every_room_is_a_package() -> None:
    for folder in PACKAGE.iterdir():
        if folder.is_dir() and any(folder.rglob("*.py")):
            assert (folder / "__init__.py").exists(), f"{folder.name} needs an __init__.py"
