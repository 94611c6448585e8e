"""codriving memory build: what is driven, what is refused, and what a finished build leaves."""

import json
from pathlib import Path
from typing import Any

import pytest
from remembered import description, experience, filled

from codriving.commands.memory_build import BUILD, build_points
from codriving.commands.memory_pages import merge_page, search_page, show_page
from codriving.commands.run import run_command, run_experiment
from codriving.config.compose import compose
from codriving.datatypes.experience import Interaction
from codriving.errors import ConfigError, MemoryFileError, ModelError
from codriving.experiment.remembering import growing, learns, merged_notes, pinned
from codriving.memory.reading import read_memory
from codriving.memory.store import MemoryStore
from codriving.runs.identity import driving_values, snapshot_of


def config(*overrides: str) -> dict[str, object]:
    return compose(build_points(overrides)[0].overrides)


def test_a_build_learns_online_on_seeds_of_its_own() -> None:
    made = config("scenario=merge", "interactions=7")
    assert (made["episodes"], made["seed"], made["experiment"]) == (7, 20_000, "memory")
    assert learns(made)
    assert len(build_points(["scenario=merge,highway"])) == 2


@pytest.mark.parametrize(
    ("overrides", "said"),
    [
        (["interactions=none"], "interactions must be a whole number, 1 to 10000, got 'none'"),
        (["interactions=0"], "interactions must be a whole number"),
        (["episodes=3"], "takes interactions=N"),
        (["memory=off"], "learns with memory=online"),
        (["seed=0"], "seeds 0 to 19 are no seeds to learn from"),
        (["seed=9999", "interactions=1"], "seeds 9999 to 9999 are no seeds to learn from"),
        (["seed=99999", "interactions=2"], "seeds 99999 to 100000 are no seeds to learn from"),
        (["seed=109999", "interactions=1"], "choose seed=20000"),
    ],
)
def test_what_cannot_be_built_is_refused(overrides: list[str], said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        build_points(overrides)


def test_a_memory_grows_in_the_run_folder_unless_it_has_a_file(tmp_path: Path) -> None:
    made = growing(config(), tmp_path, "cell")
    assert made["memory"]["file"] == str(tmp_path / "memory" / "cell.sqlite")
    own = config("memory.file=mine.sqlite")
    assert growing(own, tmp_path, "cell") == own
    plain = compose([])
    assert growing(plain, tmp_path, "cell") == plain


def test_a_snapshot_is_noted_by_its_contents_wherever_it_lies(tmp_path: Path) -> None:
    one, two = (filled(tmp_path / name, [experience()]) for name in ("1.sqlite", "2.sqlite"))
    first, second = (pinned(compose(["memory=frozen", f"memory.file={path}"])) for path in (one, two))
    assert first["memory"]["snapshot"] == second["memory"]["snapshot"] != "auto"
    assert driving_values(first) == driving_values(second)
    filled(two, [experience(step=8)], first=20_007)
    third = pinned(compose(["memory=frozen", f"memory.file={two}"]))
    assert [file.sha256 for file in snapshot_of(third)] != [file.sha256 for file in snapshot_of(second)]


def test_a_method_that_remembers_nothing_notes_nothing(tmp_path: Path) -> None:
    path = filled(tmp_path / "m.sqlite", [experience()])
    made = compose(["method=fcfs", "memory=frozen", f"memory.file={path}"])
    assert pinned(made) == made
    assert not learns(compose(["method=fcfs", "memory=online"]))


def test_a_build_can_be_stopped_and_grown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Two interactions and then two more are the same four as four at once, file and all."""
    monkeypatch.chdir(tmp_path)
    short = ["suite=honest", "scenario.time_limit=4", "scenario.cavs=2"]
    assert run_command(BUILD, [*short, "interactions=2", "run=parts"]) == 0
    assert run_command(BUILD, [*short, "interactions=4", "run=parts"]) == 0
    assert run_command(BUILD, [*short, "interactions=4", "run=whole"]) == 0
    printed = capsys.readouterr().out
    assert "Recall from it with memory=frozen memory.file=FILE." in printed
    assert printed.count("suite=honest is not the world that was fixed for suite=hard") == 3
    parts, whole = (
        read_memory(Path("outputs/memory") / run / "memory/intersection-codriving-full.sqlite")
        for run in ("parts", "whole")
    )
    assert parts.snapshot.digest == whole.snapshot.digest
    assert [i.seed for i in whole.interactions] == [20_000, 20_001, 20_002, 20_003]
    assert whole.snapshot.digest[:12] in printed
    assert "online" in Path("outputs/memory/whole/summary.csv").read_text()
    for run in ("parts", "whole"):
        records = [
            json.loads(
                (Path("outputs/memory") / run / f"episodes/intersection-codriving-full/{s}/record.json").read_text()
            )
            for s in range(20_000, 20_004)
        ]
        assert all(record["memory"] == "online" for record in records)


def test_a_method_without_a_memory_cannot_be_built_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ConfigError, match="method 'fcfs' has no memory to build"):
        run_command(BUILD, ["method=fcfs", "interactions=1"])
    assert not list(tmp_path.glob("outputs/memory/*/episodes"))


@pytest.fixture
def both(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[Path, Path]:
    monkeypatch.chdir(tmp_path)
    one = filled(
        Path("a.sqlite"), [experience(description(dttcp=0.5)), experience(description(relation="none"), step=5)]
    )
    two = filled(Path("b.sqlite"), [experience(description(dttcp=0.5), step=8)], first=30_000)
    return one, two


def test_show_says_what_a_memory_is_of(both: tuple[Path, Path]) -> None:
    page = show_page(both[0], 1)
    words = " ".join(page.split())
    assert read_memory(both[0]).snapshot.digest in page
    assert "experiences   2, made 2 times" in page
    assert "1 of intersection, codriving full, reasoner rules, seeds 20000 to 20000" in page
    assert words.count("similar actions should be avoided") == 1


def test_search_finds_by_words_and_near_numbers(both: tuple[Path, Path]) -> None:
    first = search_page("a crossing conflict with serious danger", both[0], 2).splitlines()[1]
    assert "#1," in first
    assert "#2," in search_page("no conflict", both[0], 1).splitlines()[1]
    assert "Nothing in" in search_page("zebra giraffe", both[0], 1)
    with pytest.raises(ConfigError, match="nothing to search for"):
        search_page(" ?! ", both[0], 1)


def test_the_newest_memory_below_outputs_is_taken_if_none_is_named(both: tuple[Path, Path]) -> None:
    with pytest.raises(MemoryFileError, match="there is no memory below outputs/"):
        show_page(None, 1)
    place = Path("outputs/memory/x/memory")
    place.mkdir(parents=True)
    both[0].rename(place / "a.sqlite")
    assert str(place / "a.sqlite") in show_page(None, 1)


def test_merging_counts_what_is_alike_once_and_changes_neither(both: tuple[Path, Path]) -> None:
    before = [path.read_bytes() for path in both]
    said = merge_page(*both, None, 0.98)
    assert said.startswith("a+b.sqlite: 2 experiences of 3, from 2 interactions, snapshot ")
    assert [path.read_bytes() for path in both] == before
    assert [entry.count for entry in read_memory(Path("a+b.sqlite")).snapshot.experiences] == [2, 1]
    with pytest.raises(MemoryFileError, match="is there already"):
        merge_page(*both, None, 0.98)
    assert "from 1 interactions" in merge_page(both[0], both[0], Path("same.sqlite"), 0.98)
    with pytest.raises(MemoryFileError, match="there is no file of memories"):
        merge_page(both[0], Path("none.sqlite"), Path("c.sqlite"), 0.98)
    assert not Path("c.sqlite").exists()


def test_tables_with_a_memory_are_the_same_for_any_number_of_workers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Learning is done in the order of the seeds whatever is asked for, and what is frozen depends on no order."""
    monkeypatch.chdir(tmp_path)
    short = ["scenario.time_limit=4", "scenario.cavs=2", "episodes=3", "seed=10000"]
    kept = []
    for workers in (1, 2):
        assert run_experiment([*short, "memory=online", f"workers={workers}", f"run=learnt-{workers}"]) == 0
        file = Path(f"outputs/run/learnt-{workers}/memory/intersection-codriving-full.sqlite")
        recalled = [*short, "memory=frozen", f"memory.file={file}", f"workers={workers}", f"run=recalled-{workers}"]
        assert run_experiment(recalled) == 0
        kept.append(
            {
                (what, str(path.relative_to(f"outputs/run/{what}-{workers}"))): path.read_bytes()
                for what in ("learnt", "recalled")
                for path in sorted(Path(f"outputs/run/{what}-{workers}").rglob("*"))
                if path.name in ("episodes.csv", "summary.csv", "record.json", "decisions.jsonl", "trajectory.csv")
            }
        )
        kept[-1]["memory", "bytes"] = file.read_bytes()
    assert len(kept[0]) == 2 * (2 + 3 * 3) + 1
    assert kept[0] == kept[1]


def short(tmp_path: Path, *more: str) -> list[str]:
    """A run of three short episodes that learn."""
    settings = ["run=one", "launcher=serial", "scenario.time_limit=1", "memory=online"]
    return [f"output={tmp_path / 'out'}", *settings, *more, *([] if "episodes=4" in more else ["episodes=3"])]


def test_a_memory_that_cannot_be_used_is_refused_before_the_first_episode(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(MemoryFileError, match=r"cannot write the memory .*/file/m\.sqlite"):
        run_experiment(short(tmp_path, f"memory.file={tmp_path / 'file' / 'm.sqlite'}"))
    assert not (tmp_path / "out").exists()
    assert run_experiment(short(tmp_path)) == 0
    (memory,) = (tmp_path / "out").glob("run/one/memory/*.sqlite")
    memory.write_bytes(b"garbage " * 100)
    with pytest.raises(MemoryFileError, match="cannot be read as a file of memories"):
        run_experiment(short(tmp_path, "episodes=4"))
    assert len(list((tmp_path / "out").glob("run/one/episodes/*/*"))) == 3


def test_a_memory_that_fails_meanwhile_ends_the_batch_and_keeps_what_is_finished(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    add = MemoryStore.add

    def fails(self: MemoryStore, learnt: Interaction, *args: Any, **more: Any) -> int:
        if learnt.seed == 1:
            raise MemoryFileError("cannot write the memory: database or disk is full; make room")
        return add(self, learnt, *args, **more)

    monkeypatch.setattr(MemoryStore, "add", fails)
    with pytest.raises(
        ModelError, match=r"disk is full; make room; 1 of 3 episodes .* kept; go on with: codriving run"
    ):
        run_experiment(short(tmp_path))
    monkeypatch.undo()
    assert run_experiment(short(tmp_path)) == 0


def test_a_memory_that_merges_nearly_everything_says_so(tmp_path: Path) -> None:
    told = [experience(step=step) for step in range(9)]
    path = filled(tmp_path / "m.sqlite", [*told, experience(description(dttcp=7.5), step=9)])
    config = compose(["memory=online", f"memory.file={path}"])
    (note,) = merged_notes([config])
    assert note.startswith(
        f"{path}: of 10 experiences only 2 are kept, since the others are too like one of them; raise"
    )
    assert "memory.duplicates, which is 0.98, or choose another memory.embedder, and" in note
    # Half is not more than half, and of a few nothing can be said.
    kinds = ("crossing", "converging", "weaving", "diverging", "none")
    half = [experience(description(relation=k), step=2 * n + again) for n, k in enumerate(kinds) for again in (0, 1)]
    for name, learnt in (("half", half), ("few", told)):
        made = filled(tmp_path / f"{name}.sqlite", learnt)
        assert list(merged_notes([compose(["memory=online", f"memory.file={made}"])])) == []
    assert list(merged_notes([compose([]), compose(["memory=online", "memory.file=none.sqlite"])])) == []


def test_a_build_that_merges_says_so_on_the_screen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(
        "codriving.experiment.batch.merged_notes", lambda configs: [c["memory"]["file"] for c in configs]
    )
    assert run_experiment(short(tmp_path)) == 0
    assert (
        str(tmp_path / "out" / "run" / "one" / "memory" / "intersection-codriving-full.sqlite")
        in capsys.readouterr().err
    )
