"""Run folders of version 0.1: they are reported and replayed, and not extended, since behaviour 1 drove them."""

import csv
import shutil
from pathlib import Path

import pytest
from cells import MEMORY
from driving import codriving, comparable

HERE = Path(__file__).parent
MADE = HERE / "folder-0.1" / "run"
SETTINGS = (
    "scenario=intersection", "scenario.cavs=2", "scenario.hdvs=[1,1]", "scenario.simulation_frequency=5",
    "scenario.decision_frequency=1", "seed=10000", "launcher=serial", "suite=paper",
)  # fmt: skip
PLAIN = ("run", *SETTINGS, "method=codriving,fcfs", "scenario.time_limit=16")
FROZEN = ("run", *SETTINGS, "memory=frozen", f"memory.file={MEMORY}", "scenario.time_limit=6")
PNG = b"\x89PNG\r\n\x1a\n"


@pytest.fixture
def folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Copies of the folders, below the folder in which the commands are given."""
    shutil.copytree(MADE, tmp_path / "outputs" / "run")
    shutil.copy(HERE / MEMORY, tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path / "outputs" / "run"


TABLES = ("episodes.csv", "summary.csv")
LOCAL = ("timing.json", "decisions.jsonl", "SHA256SUMS")


def driven(folder: Path) -> dict[str, bytes]:
    """Files of the episodes, by cell, but for the decisions, whose last digits depend on the machine."""
    files = [path for path in folder.glob("episodes/*/*/*") if path.name not in LOCAL]
    return {path.relative_to(folder).as_posix(): comparable(path) for path in files}


def everything(folder: Path) -> dict[str, bytes]:
    """All files but the lock."""
    files = [path for path in folder.rglob("*") if path.is_file() and path.name != ".lock"]
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


@pytest.mark.parametrize(
    ("name", "command", "count"), [("plain", (*PLAIN, "episodes=2"), 4), ("frozen", (*FROZEN, "episodes=1"), 1)]
)
def test_the_same_command_finds_nothing_to_do(folders: Path, name: str, command: tuple[str, ...], count: int) -> None:
    code, said = codriving(*command, f"run={name}")
    assert code == 0, said
    assert f"Nothing to do: all {count} episodes of this run are finished already." in said
    before, now = everything(MADE / name), everything(folders / name)
    assert sorted(before) == sorted(now)
    # What people read may be worded anew, and later columns are empty.
    assert [path for path in before if before[path] != now[path] and path not in ("summary.md", *TABLES)] == []
    for path in TABLES:
        old, new = (list(csv.DictReader(files[path].decode().splitlines())) for files in (before, now))
        assert [{key: row[key] for key in old[0]} for row in new] == old
        assert {row[key] for row in new for key in row if key not in old[0]} == {""}


@pytest.mark.parametrize(("name", "command", "seeds"), [("plain", PLAIN, 3), ("frozen", FROZEN, 2)])
def test_a_run_is_not_extended(folders: Path, name: str, command: tuple[str, ...], seeds: int) -> None:
    code, said = codriving(*command, f"episodes={seeds}", f"run={name}")
    assert code == 2
    assert said.splitlines()[-1] == (
        f"error: {Path('outputs', 'run', name)} was driven by codriving 0.1.0 (behaviour 1, here 5), so it can be "
        "replayed and reported but not extended; extend it with codriving 0.1.0, or choose another run=<name>"
    )
    assert everything(folders / name) == everything(MADE / name)


def test_the_same_command_without_the_suite_is_told_of_it(folders: Path) -> None:
    code, said = codriving(*(token for token in PLAIN if token != "suite=paper"), "episodes=2", "run=plain")
    assert code == 2
    assert "repeat its settings, of which suite=paper is the world unless it named another, to go on" in said
    assert "limits.braking was absent, is now 8.0" in said or "drivers" in said
    assert everything(folders / "plain") == everything(MADE / "plain")


@pytest.mark.parametrize(
    ("name", "which"),
    [("plain", ("--cell", "codriving")), ("plain", ("--cell", "fcfs")), ("frozen", ()), ("asked", ())],
)
def test_a_stored_episode_is_replayed(folders: Path, name: str, which: tuple[str, ...]) -> None:
    code, said = codriving("replay", name, *which, "--frame", "3", "--out", "frame.png")
    assert code == 0, said
    assert Path("frame.png").read_bytes().startswith(PNG)


def test_a_memory_is_read(folders: Path) -> None:
    code, said = codriving("memory", "show", MEMORY)
    assert code == 0, said
    assert "4575c0a7909592b6d4952a2e237964b83154d8ae674656692e2a270d10cc746f" in said
    assert "41, made 48 times" in said
