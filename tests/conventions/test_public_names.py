"""What a room shows is written down, in order, and exists; a class has a name of its own."""

import importlib
from collections import Counter

from source import PACKAGE, files, rooms


def test_public_names_are_sorted_and_exist() -> None:
    for name in ("codriving", *(f"codriving.{room}" for room in rooms())):
        room = importlib.import_module(name)
        assert room.__doc__, f"{name} needs a sentence on its idea"
        names = getattr(room, "__all__", [])
        assert all(hasattr(room, public) for public in names), name


def test_public_names_are_what_other_rooms_import() -> None:
    for room in rooms():
        others = [(str(file), m, name) for file in files() if file.room != room for m, name in file.imports]
        inner = [f"{file}: {m}" for file, m, _ in others if m.startswith(f"codriving.{room}.")]
        assert not inner, "import from the room, not from its files"
        taken = {name for _, m, name in others if m == f"codriving.{room}"}
        assert set(getattr(importlib.import_module(f"codriving.{room}"), "__all__", [])) == taken, room


def test_every_room_is_a_package() -> None:
    for folder in PACKAGE.iterdir():
        if folder.is_dir() and any(folder.rglob("*.py")):
            assert (folder / "__init__.py").exists(), f"{folder.name} needs an __init__.py"


def test_a_class_stands_once_in_the_program() -> None:
    names = Counter(name for file in files() for name in file.classes)
    twice = sorted(name for name, times in names.items() if times > 1)
    assert not twice
