"""Who may import whom: the table of docs/architecture.md, read off the source."""

import re
from graphlib import TopologicalSorter

from source import PACKAGE, REPOSITORY, files, modules, targets

EVERYWHERE = {"datatypes", "errors", "version"}

MAY_IMPORT = {
    "errors": set[str](),
    "version": set(),
    "datatypes": set(),
    "geometry": set(),
    "environment": {"geometry"},
    "reasoning": {"geometry"},
    "judgement": {"geometry", "reasoning", "llm"},
    "briefing": {"reasoning"},
    "llm": set(),
    "memory": {"llm"},
    "methods": {"geometry", "reasoning", "judgement", "briefing", "protocol", "memory", "llm"},
    "wrappers": {"geometry", "reasoning", "protocol", "methods"},
    "protocol": {"reasoning"},
    "v2x": {"geometry"},
    "bound": {"geometry", "environment"},
    "gym": {"geometry", "environment", "reasoning", "config", "animation"},
    "training": {"geometry", "reasoning", "methods", "gym", "config", "runs"},
    "metrics": {"geometry"},
    "animation": {"geometry"},
    "runs": set(),
    "recordings": set(),
    "reports": {"metrics", "runs", "memory"},
    "pages": {"geometry", "animation", "reports", "runs"},
    "config": set(),
    "experiment": {"config", "runs", "reports", "metrics", "memory", "animation", "judgement"},
    "exam": {
        *("geometry", "environment", "reasoning", "judgement", "briefing", "llm", "methods", "metrics"),
        *("config", "runs", "experiment"),
    },
    "commands": {
        "bound",
        "config",
        "exam",
        "experiment",
        "memory",
        "metrics",
        "recordings",
        "reports",
        "runs",
        "animation",
        "pages",
    },
    "api": {"commands", "config", "experiment", "reports", "runs"},
    "cli": {"config", "commands", "training"},
    "scenarios": {"environment", "geometry"},
    "ordering": {"reasoning"},
    "__main__": {"cli"},
    "__init__": {"api", "gym"},
}
"""What each room may import besides itself and ``EVERYWHERE``, for types and by names in texts included."""

DOORS = {
    "highway_env": "environment",
    "dask": "experiment",
    "distributed": "experiment",
    "gymnasium": "gym",
    "pettingzoo": "gym",
    "litellm": "llm",
    "xllamacpp": "llm",
    "faiss": "memory",
    "safetensors": "methods",
    "torch": "training",
    "stable_baselines3": "training",
    "hydra": "config",
    "omegaconf": "config",
    "typer": "cli",
    "click": None,
}


def used() -> dict[str, dict[str, str]]:
    """What each room imports of others, each with a file that does."""
    found: dict[str, dict[str, str]] = {room: {} for room in MAY_IMPORT}
    for file in files():
        for target in targets(file):
            other = modules()[target].room
            if other != file.room and other not in EVERYWHERE:
                found.setdefault(file.room, {})[other] = str(file)
    return found


def test_every_room_has_a_row() -> None:
    assert {file.room for file in files()} == set(MAY_IMPORT), "a new room needs a row here and in docs/architecture.md"


def test_the_page_shows_this_table() -> None:
    page = (REPOSITORY / "docs" / "architecture.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\|[^|]*\| `(\w+)/`[^|]*\|[^|]*\|([^|]*)\|$", page, re.M)
    shown = {room: set(re.findall(r"\w+", imports)) for room, imports in rows}
    assert shown == {room: MAY_IMPORT[room] - {"__init__"} for room in shown}
    assert len(shown) == 27


def test_rooms_import_only_what_they_may() -> None:
    beyond = {room: {k: v for k, v in of.items() if k not in MAY_IMPORT[room]} for room, of in used().items()}
    assert {room: of for room, of in beyond.items() if of} == {}


def test_every_permission_is_used() -> None:
    assert {room: may - set(used()[room]) for room, may in MAY_IMPORT.items() if may - set(used()[room])} == {}


def test_each_library_has_one_door() -> None:
    for file in files():
        for module, _ in file.imports:
            library = module.partition(".")[0]
            assert file.room == DOORS.get(library, file.room), f"{file}: only {DOORS[library]} may import {library}"


def test_no_circle_of_files() -> None:
    graph = {file.module: set(targets(file)) for file in files()}
    TopologicalSorter(graph).prepare()


def test_errors_and_datatypes_stand_on_nothing() -> None:
    for file in files():
        if file.room in EVERYWHERE:
            assert {modules()[target].room for target in targets(file)} <= {file.room}, str(file)


def test_no_room_for_odds_and_ends() -> None:
    forbidden = {"utils", "util", "common", "core", "helpers", "misc"}
    assert not [p for p in PACKAGE.rglob("*") if p.stem in forbidden]
