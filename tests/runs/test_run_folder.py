"""Run folders: made, resumed, refused; nothing in them is ever lost."""

import dataclasses
from datetime import datetime
from pathlib import Path

import pytest
from manifests import CONFIGS, cell, files, manifest

from codriving.datatypes.record import EpisodeRecord
from codriving.errors import RunFolderError
from codriving.runs.atomic import PARTIAL
from codriving.runs.episode_folder import read_timing, timing_of, write_episode
from codriving.runs.json_files import encode
from codriving.runs.manifest import read_manifest
from codriving.runs.run_folder import RunFolder, new_run_path


def test_a_new_folder_holds_config_and_manifest(tmp_path: Path) -> None:
    path = tmp_path / "outputs" / "run" / "mine"
    with RunFolder(path, manifest(), {"a-cell": "seed: 0\n"}):
        assert (path / "config.yaml").read_text() == "seed: 0\n"
        assert (path / "configs" / "a-cell.yaml").read_text() == "seed: 0\n"
        assert read_manifest(path) == manifest()


def test_resuming_changes_nothing_and_sweeps(tmp_path: Path) -> None:
    with RunFolder(tmp_path / "r", manifest(), {"a-cell": "seed: 0\n"}):
        pass
    before = files(tmp_path / "r")
    leftover = tmp_path / "r" / "episodes" / "a-cell" / f"{PARTIAL}3-abc"
    leftover.mkdir(parents=True)
    (tmp_path / "r" / f"{PARTIAL}summary.csv-1").touch()
    later = dataclasses.replace(manifest(), created="2027-01-01T00:00:00+00:00")
    with RunFolder(tmp_path / "r", later, {"a-cell": "other text\n"}) as folder:
        assert folder.manifest == manifest()
    assert files(tmp_path / "r") == before
    assert not leftover.exists()


def test_another_config_is_refused_with_the_keys_that_differ(tmp_path: Path) -> None:
    with RunFolder(tmp_path, manifest(cell("f1", **{"scenario.cavs": "4", "scenario.hdvs": "3"})), CONFIGS):
        pass
    before = files(tmp_path)
    other = manifest(cell("f2", **{"scenario.cavs": "8", "scenario.hdvs": "3", "scenario.rain": "true"}))
    with pytest.raises(RunFolderError) as caught:
        RunFolder(tmp_path, other, CONFIGS)
    assert "scenario.cavs was 4, is now 8, scenario.rain was absent, is now true" in str(caught.value)
    assert "another run=<name>" in str(caught.value)
    assert "hdvs" not in str(caught.value)
    assert files(tmp_path) == before


def test_a_folder_of_another_user_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("years of work")
    with pytest.raises(RunFolderError, match=r"no run folder \(it holds thesis.tex\)"):
        RunFolder(tmp_path, manifest(), CONFIGS)
    assert files(tmp_path).keys() == {"thesis.tex", ".lock"}


def test_a_folder_killed_before_its_manifest_is_begun_again(tmp_path: Path) -> None:
    (tmp_path / "config.yaml").write_text("half")
    with RunFolder(tmp_path, manifest(), {"a-cell": "whole\n"}):
        assert (tmp_path / "config.yaml").read_text() == "whole\n"


def test_a_damaged_manifest_is_named(tmp_path: Path) -> None:
    with RunFolder(tmp_path, manifest(), CONFIGS):
        pass
    (tmp_path / "manifest.json").write_text("{")
    with pytest.raises(RunFolderError, match=r"manifest\.json is damaged"):
        RunFolder(tmp_path, manifest(), CONFIGS)


def test_two_runs_cannot_write_one_folder(tmp_path: Path) -> None:
    with RunFolder(tmp_path, manifest(), CONFIGS), pytest.raises(RunFolderError, match="being written by another run"):
        RunFolder(tmp_path, manifest(), CONFIGS)
    with RunFolder(tmp_path, manifest(), CONFIGS):
        pass


def test_an_unwritable_output_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(RunFolderError, match=r"cannot write the run folder .* Not a directory; choose another output"):
        RunFolder(tmp_path / "file" / "run" / "mine", manifest(), CONFIGS)
    for experiment in (tmp_path / "file", tmp_path / "file" / "run"):
        with pytest.raises(RunFolderError, match="choose another output"):
            new_run_path(experiment, datetime(2026, 1, 2))


def test_runs_of_one_second_get_folders_of_their_own(tmp_path: Path) -> None:
    now = datetime(2026, 1, 2, 3, 4, 5)
    assert [new_run_path(tmp_path / "run", now).name for _ in range(2)] == ["2026-01-02_030405", "2026-01-02_030405-2"]


def test_a_record_in_the_wrong_place_is_damage(tmp_path: Path, record: EpisodeRecord) -> None:
    with RunFolder(tmp_path, manifest(), CONFIGS) as folder:
        assert folder.record(cell(), 7) is None
        for seed in (7, 8):
            write_episode(folder.episode("a-cell", seed), record, None, [], timing_of(1.0, [0.25, 0.75]))
        assert folder.record(cell(), 7) == record
        assert (read_timing(folder.episode("a-cell", 7)) or timing_of(0, [])).decision_mean == 0.5
        with pytest.raises(RunFolderError, match=r"8/record\.json is damaged \(it is the record of"):
            folder.record(cell(), 8)


def test_an_episode_folder_holds_its_files_and_no_clock_in_them(tmp_path: Path, record: EpisodeRecord) -> None:
    for name, seconds in (("a", 1.0), ("b", 2.0)):
        write_episode(tmp_path / name, record, None, [{"step": 0}], timing_of(seconds, []), "Traceback ...")
    a, b = files(tmp_path / "a"), files(tmp_path / "b")
    assert a.keys() == {"record.json", "decisions.jsonl", "timing.json", "error.txt", "SHA256SUMS"}
    assert a.pop("timing.json") != b.pop("timing.json")
    assert a == b


def test_a_full_disk_is_one_line_for_the_user(tmp_path: Path, record: EpisodeRecord) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(RunFolderError, match="finished episodes are kept"):
        write_episode(tmp_path / "file" / "7", record, None, [], timing_of(1.0, []))


def test_the_manifest_tells_nothing_of_the_environment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OPENAI_API_KEY", "canary-5f1e")
    with RunFolder(tmp_path, manifest(), CONFIGS):
        pass
    assert not any(b"canary-5f1e" in content for content in files(tmp_path).values())


@pytest.mark.parametrize(
    "name",
    [
        "\x1b[2J",
        "evil.",
        "evil ",
        "a" * 300,
        "\u202egnp.exe",
        "",
        ".",
        "..",
        "../../evil",
        "/tmp/evil",
        "a/b",
        "..\\..\\evil",
        "C:evil",
        "a\0b",
        ".lock",
        ".partial-x",
        "a\nb",
    ],
)
def test_a_name_in_a_manifest_is_that_of_a_folder_and_nothing_else(tmp_path: Path, name: str) -> None:
    (tmp_path / "manifest.json").write_text(encode(manifest(dataclasses.replace(cell(), folder=name))))
    with pytest.raises(RunFolderError, match=r"manifest\.json is damaged \(.* is no name of a folder\)") as caught:
        read_manifest(tmp_path)
    assert str(caught.value).isprintable()


def test_names_that_runs_have_made_are_read(tmp_path: Path) -> None:
    for name in ("intersection-codriving-full-scenario.cavs=8", "merge-fcfs", "a-llm.model=openai_gpt-4o+x", "übung-a"):
        (tmp_path / "manifest.json").write_text(encode(manifest(dataclasses.replace(cell(), folder=name))))
        found = read_manifest(tmp_path)
        assert found is not None
        assert found.rows == (name,)


def test_rows_of_a_manifest_are_among_its_cells(tmp_path: Path) -> None:
    (tmp_path / "manifest.json").write_text(encode(dataclasses.replace(manifest(), rows=("another",))))
    with pytest.raises(RunFolderError, match="rows are not its cells"):
        read_manifest(tmp_path)
    (tmp_path / "manifest.json").write_text("[" * 100_000)
    with pytest.raises(RunFolderError, match=r"manifest\.json is damaged"):
        read_manifest(tmp_path)


def test_a_name_that_is_too_long_is_to_be_shortened(tmp_path: Path) -> None:
    with pytest.raises(RunFolderError, match=r"File name too long; choose a shorter run=<name> or output=<folder>$"):
        RunFolder(tmp_path / ("x" * 300), None, {})  # type: ignore[arg-type]
