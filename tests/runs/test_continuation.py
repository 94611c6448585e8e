"""What a run folder takes beside what it holds: more episodes, more cells of the same experiment, nothing else."""

import dataclasses
import json
from pathlib import Path

import pytest
from manifests import CONFIGS, cell, files, manifest

from codriving.datatypes.record import EpisodeRecord
from codriving.errors import RunFolderError
from codriving.runs.continuation import changed_versions, continued
from codriving.runs.episode_folder import timing_of, write_episode
from codriving.runs.identity import CellEntry, NamedFile
from codriving.runs.manifest import Manifest, read_manifest
from codriving.runs.run_folder import RunFolder


def named(folder: str, fingerprint: str, **swept: str) -> CellEntry:
    return dataclasses.replace(cell(fingerprint), folder=folder, swept=swept)


def asked(*cells: CellEntry, episodes: int = 20) -> Manifest:
    return dataclasses.replace(manifest(*cells), episodes=episodes)


HERE = Path("outputs/run/x")


def test_the_same_again_changes_nothing() -> None:
    there = asked(named("a", "f1"), named("b", "f2"))
    later = dataclasses.replace(there, created="2027-01-01T00:00:00+00:00")
    assert continued(HERE, there, later) == there


@pytest.mark.parametrize("episodes", [5, 200])
def test_any_number_of_episodes_may_be_asked_for(episodes: int) -> None:
    there = asked(named("a", "f1"))
    assert continued(HERE, there, asked(named("a", "f1"), episodes=episodes)).episodes == episodes


def test_cells_are_added_in_the_order_asked_for_and_none_is_forgotten() -> None:
    there = asked(named("a", "f1"), named("b", "f2"))
    grown = continued(HERE, there, asked(named("c", "f3"), named("b", "f2")))
    assert grown.rows == ("c", "b")
    assert [entry.folder for entry in grown.cells] == ["a", "b", "c"]
    again = continued(HERE, grown, asked(named("a", "f1")))
    assert (again.rows, len(again.cells)) == (("a",), 3)


def test_a_cell_keeps_its_folder_and_takes_the_new_label() -> None:
    there = asked(named("plain", "f1"))
    grown = continued(HERE, there, asked(named("cavs=8", "f2", cavs="8"), named("cavs=4", "f1", cavs="4")))
    assert grown.rows == ("cavs=8", "plain")
    assert {entry.folder: entry.swept for entry in grown.cells} == {"plain": {"cavs": "4"}, "cavs=8": {"cavs": "8"}}


def test_a_new_cell_never_gets_the_folder_of_another() -> None:
    there = asked(named("Plain", "f1"))
    grown = continued(HERE, there, asked(named("other", "f1"), named("PLAIN", "f2")))
    assert grown.rows == ("Plain", "PLAIN-f2")


def test_without_a_cell_in_common_it_is_another_config() -> None:
    there = asked(dataclasses.replace(cell("f1"), settings={"scenario.cavs": "4"}))
    other = asked(dataclasses.replace(cell("f2"), settings={"scenario.cavs": "8"}))
    with pytest.raises(RunFolderError, match=r"another config: scenario\.cavs was 4, is now 8; repeat its settings"):
        continued(HERE, there, other)


def test_the_difference_is_told_to_the_cell_that_is_most_alike() -> None:
    far = dataclasses.replace(cell("f1"), settings={"a": "1", "b": "1"})
    near = dataclasses.replace(cell("f2"), settings={"a": "1", "b": "2"})
    with pytest.raises(RunFolderError, match=r"another config: a was 1, is now 3; "):
        continued(HERE, asked(far, near), asked(dataclasses.replace(cell("f3"), settings={"a": "3", "b": "2"})))


def test_what_goes_on_with_another_version_is_named() -> None:
    before = dataclasses.replace(asked(), versions={"numpy": "1", "scipy": "1"}, commit="abc")
    now = dataclasses.replace(asked(), versions={"numpy": "2", "scipy": "1", "faiss-cpu": "1"}, commit=None)
    assert changed_versions(before, now) == ("commit abc -> none", "faiss-cpu none -> 1", "numpy 1 -> 2")
    assert changed_versions(before, before) == ()


def test_a_folder_that_grows_keeps_what_it_has(tmp_path: Path, record: EpisodeRecord) -> None:
    with RunFolder(tmp_path, manifest(), CONFIGS) as folder:
        for seed in (3, 7, 30):
            write_episode(folder.episode("a-cell", seed), record, None, [], timing_of(1.0, []))
    before = files(tmp_path)
    more = asked(named("b", "f2"), named("new name", "f1"), episodes=8)
    with RunFolder(tmp_path, more, {"b": "cavs: 8\n", "new name": "cavs: 4\n"}) as folder:
        assert folder.manifest.rows == ("b", "a-cell")
        assert folder.left_out(range(8)) == 1
    after = files(tmp_path)
    changed = {name for name in before if before[name] != after[name]}
    assert changed == {"manifest.json", "config.yaml", "configs/a-cell.yaml"}
    assert after["config.yaml"] == after["configs/b.yaml"] == b"cavs: 8\n"
    assert after["configs/a-cell.yaml"] == b"cavs: 4\n"
    with RunFolder(tmp_path, asked(named("b", "f2"), episodes=1), {"b": ""}) as folder:
        assert folder.left_out(range(1)) == 3


def old(folder: Path, layout: int = 2, **settings: str) -> Path:
    """Make a manifest one of release 0.1, or of the layout before."""
    path = folder / "manifest.json"
    plain = json.loads(path.read_text())
    (entry,) = plain["cells"]
    for name in ("choices", "files"):
        del entry[name]
    entry["settings"] |= {"method._target_": '"codriving.old.Place"', "plugins": '["theirs"]', **settings}
    del plain["behaviour"]
    plain["format"] = layout
    if layout == 1:
        del plain["rows"], entry["swept"]
    path.write_text(json.dumps(plain))
    return path


@pytest.mark.parametrize("layout", [1, 2])
def test_a_folder_of_release_0_1_is_read_and_not_extended(tmp_path: Path, record: EpisodeRecord, layout: int) -> None:
    here = manifest(dataclasses.replace(cell("f9", **{"method.margin": "1.5"})))
    with RunFolder(tmp_path, here, CONFIGS):
        pass
    path = old(tmp_path, layout)
    found = read_manifest(tmp_path)
    assert found is not None
    assert (found.rows, found.behaviour, found.cells[0].choices) == (("a-cell",), 1, {})
    assert found.cells[0].settings == {"seed": "0", "method.margin": "1.5"}
    before = path.read_bytes()
    with pytest.raises(RunFolderError, match=r"\(behaviour 1, here 5\).* not extended"):
        RunFolder(tmp_path, here, CONFIGS)
    assert path.read_bytes() == before


def test_a_finished_folder_of_release_0_1_stays_to_the_byte(tmp_path: Path, record: EpisodeRecord) -> None:
    here = dataclasses.replace(manifest(cell("f9", **{"method.margin": "1.5"})), first_seed=7, episodes=1)
    with RunFolder(tmp_path, here, CONFIGS) as folder:
        write_episode(folder.episode("a-cell", 7), record, None, [], timing_of(1.0, []))
    old(tmp_path)
    before = files(tmp_path)
    with RunFolder(tmp_path, here, CONFIGS):
        pass
    assert files(tmp_path) == before


def test_a_changed_file_is_refused_and_named(tmp_path: Path) -> None:
    template = NamedFile("template decide.user.md.j2", "mine/decide.user.md.j2", "aa")
    with RunFolder(tmp_path, manifest(dataclasses.replace(cell(), files=(template,))), CONFIGS):
        pass
    before = files(tmp_path)
    edited = dataclasses.replace(cell("f2"), files=(dataclasses.replace(template, sha256="bb"),))
    with pytest.raises(RunFolderError, match=r"^mine/decide\.user\.md\.j2 \(.*\) has changed since .*restore it"):
        RunFolder(tmp_path, manifest(edited), CONFIGS)
    assert files(tmp_path) == before
    both = manifest(edited, named("b", "f3", cavs="8"))
    with pytest.raises(RunFolderError, match="has changed"):
        RunFolder(tmp_path, both, {**CONFIGS, "b": ""})


def test_of_a_version_between_releases_the_commit_is_named(tmp_path: Path) -> None:
    versions = {"codriving": "0.2.0.dev0"}
    here = dataclasses.replace(manifest(), behaviour=2, versions=versions, commit="0123456789abcdef")
    with RunFolder(tmp_path, dataclasses.replace(here, behaviour=5), CONFIGS):
        pass
    path = tmp_path / "manifest.json"
    path.write_text(path.read_text().replace('"behaviour": 5', '"behaviour": 2'))
    with pytest.raises(RunFolderError, match=r"extend it with codriving 0\.2\.0\.dev0 of commit 0123456789, or choose"):
        RunFolder(tmp_path, dataclasses.replace(here, episodes=21), CONFIGS)


@pytest.mark.parametrize(("behaviour", "named"), [(1, True), (2, True), (3, False), (4, False)])
def test_of_a_folder_of_before_the_world_is_named(tmp_path: Path, behaviour: int, named: bool) -> None:
    with RunFolder(tmp_path, dataclasses.replace(manifest(cell("f1", seed="0")), behaviour=behaviour), CONFIGS):
        pass
    with pytest.raises(RunFolderError, match=r"limits\.braking was absent, is now 8\.0") as refused:
        RunFolder(tmp_path, manifest(cell("f2", **{"limits.braking": "8.0"})), CONFIGS)
    assert ("suite=paper" in str(refused.value)) == named


def test_a_folder_of_another_behaviour_is_reported_and_not_extended(tmp_path: Path, record: EpisodeRecord) -> None:
    here = dataclasses.replace(manifest(), first_seed=7, episodes=1, versions={"codriving": "0.9"})
    with RunFolder(tmp_path, here, CONFIGS) as folder:
        write_episode(folder.episode("a-cell", 7), record, None, [], timing_of(1.0, []))
    path = tmp_path / "manifest.json"
    path.write_text(path.read_text().replace('"behaviour": 5', '"behaviour": 7'))
    before = files(tmp_path)
    now = dataclasses.replace(here, versions={"codriving": "0.2"})
    with RunFolder(tmp_path, now, CONFIGS) as folder:
        assert folder.record(cell(), 7) == record
    for more in (dataclasses.replace(now, episodes=2), asked(cell(), named("b", "f2"), episodes=1)):
        with pytest.raises(RunFolderError, match=r"by codriving 0\.9 \(behaviour 7, here 5\).* not extended"):
            RunFolder(tmp_path, dataclasses.replace(more, first_seed=7), {**CONFIGS, "b": ""})
    assert files(tmp_path) == before


@pytest.mark.parametrize("name", ["..", "../elsewhere", "/etc", "a\\b", "C:x", ""])
def test_a_manifest_never_leads_out_of_its_folder(tmp_path: Path, name: str) -> None:
    with RunFolder(tmp_path, manifest(), CONFIGS):
        pass
    path = tmp_path / "manifest.json"
    plain = json.loads(path.read_text())
    plain["cells"][0]["folder"] = name
    path.write_text(json.dumps(plain))
    with pytest.raises(RunFolderError, match="is no name of a folder"):
        read_manifest(tmp_path)


def test_a_folder_of_a_later_version_is_not_called_damaged(tmp_path: Path) -> None:
    (tmp_path / "manifest.json").write_text('{"format": 4, "new": 1}')
    with pytest.raises(RunFolderError, match=r"written by a later version \(layout 4, not 3\)"):
        read_manifest(tmp_path)
