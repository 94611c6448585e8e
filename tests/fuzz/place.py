"""A folder in which a command line is tried: a small run, a memory, and files that are hard to read."""

import sqlite3
from pathlib import Path

from tests.fuzz.trial import tried

SCENARIO = "# A scenario.\n_target_: {target}\n"

YAMLS = {
    "broken": b"a: [1, 2\nb: }",
    "deep": b"_target_: codriving.x\na: " + b"[" * 3000 + b"]" * 3000,
    "twice": b"# Twice.\n_target_: a.b\n_target_: c.d\n",
    "list": b"- a\n- b\n",
    "latin": "# Pr\xfcfung\n_target_: a.b\n".encode("latin-1"),
    "ours": b"# Ours, and strange.\n_target_: codriving.errors.ConfigError\n",
    "raises": b"# Raises.\n_target_: fuzzed_plugin.roads.Raises\nplugins: [fuzzed_plugin]\n",
    "exits": b"# Cannot be imported.\n_target_: fuzzed_plugin.broken.Road\nplugins: [fuzzed_plugin]\n",
    "types": b"# No scenario.\n_target_: fuzzed_plugin.roads.Other\nplugins: [fuzzed_plugin]\n",
}

ROADS = """
from codriving.scenarios import Scenario


class Raises(Scenario):
    def __init__(self) -> None:
        raise TypeError("a fault of the plug-in")

    name = road = pace = scene = None


class Other:
    pass
"""


def make_place(folder: Path) -> None:
    """Fill a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    outputs = f"output='{folder / 'outputs'}'"
    common = [outputs, "episodes=1", "launcher=serial", "scenario.time_limit=2"]
    for line in (
        ["run", *common, "run=small"],
        ["memory", "build", *common[:1], *common[2:], "interactions=1", "run=a"],
    ):
        made = tried(line, folder)
        assert made.code == 0, made
    (memory,) = folder.glob("outputs/memory/a/memory/*.sqlite")
    whole = memory.read_bytes()
    (folder / "small.sqlite").write_bytes(whole)
    (folder / "damaged.sqlite").write_bytes(whole[:5000] + b"\xff" * 3000 + whole[8000:])
    (folder / "empty.sqlite").write_bytes(b"")
    connection = sqlite3.connect(folder / "other.sqlite")
    connection.executescript("CREATE TABLE about (x); PRAGMA user_version = 1")
    connection.close()
    (folder / "file.txt").write_text("text\n")
    (folder / "empty").mkdir()
    (folder / "loop").symlink_to("loop")
    (folder / "forbidden").mkdir(mode=0)
    (folder / "film").mkdir()
    (folder / "conf" / "scenario").mkdir(parents=True)
    (folder / "odd" / "scenario").mkdir(parents=True)
    for name, content in YAMLS.items():
        (folder / "odd" / "scenario" / f"{name}.yaml").write_bytes(content)
    plugin = folder / "fuzzed_plugin"
    plugin.mkdir()
    (plugin / "__init__.py").write_text("")
    (plugin / "roads.py").write_text(ROADS)
    (plugin / "broken.py").write_text("def road(:\n")
