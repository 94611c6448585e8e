"""Stored episodes are found by what people call them; what is not there is answered with what is."""

import contextlib
import json
import shutil
from pathlib import Path

import pytest
from driven_run import driven_run

from codriving.commands.run import run_experiment
from codriving.environment.scenarios.intersection import Intersection
from codriving.errors import ConfigError, RunFolderError
from codriving.experiment.stored import _filled, all_episodes, find_episode, find_run, read_film, road_of
from codriving.runs.episode_folder import DECISIONS, RECORD
from codriving.runs.manifest import MANIFEST
from codriving.runs.trajectory_file import TRAJECTORY


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run of two cells with two short episodes each."""
    cells = "scenario.cavs=2,3", "scenario.leg_length=100,120"
    return driven_run(tmp_path_factory.mktemp("outputs"), "episodes=2", "seed=3", "scenario.time_limit=1", *cells)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run of one cell."""
    return driven_run(tmp_path_factory.mktemp("whole"), "episodes=3", "scenario.time_limit=1")


@pytest.fixture
def single(whole: Path, tmp_path: Path) -> Path:
    """A copy of it, to be spoilt."""
    return shutil.copytree(whole, tmp_path / "run" / "one")


def test_an_episode_is_found_by_cell_and_seed(swept: Path) -> None:
    found = find_episode(swept, "cavs=3-scenario.leg_length=120", 4)
    assert (found.seed, found.folder.name) == (4, "4")
    assert found.cell.swept == {"scenario.cavs": "3", "scenario.leg_length": "120"}
    assert (found.folder / RECORD).exists()


def test_every_cell_has_its_own_road(swept: Path) -> None:
    lengths = []
    for name in ("cavs=2-scenario.leg_length=100", "cavs=2-scenario.leg_length=120"):
        road = road_of(find_episode(swept, name, 3).cell)
        lengths.append(max(abs(lane.shape.start[1]) for lane in road.lanes if hasattr(lane.shape, "start")))
    assert lengths[1] - lengths[0] == pytest.approx(20.0)
    assert road.name == Intersection.name


@pytest.mark.parametrize(
    ("cell", "seed", "said"),
    [
        (None, 3, "holds 4 cells; choose one with --cell: intersection-codriving-full-scenario.cavs=2"),
        ("nothing", 3, "has no cell nothing; cells: intersection-codriving-full"),
        ("cavs=2", 3, "several cells of .* are called like cavs=2: .*=100.*=120"),
        ("cavs=2-scenario.leg_length=100", 9, "has no episode with seed 9; seeds: 3 to 4"),
    ],
)
def test_what_is_not_there_is_answered_with_what_is(swept: Path, cell: str | None, seed: int, said: str) -> None:
    with pytest.raises(RunFolderError, match=said):
        find_episode(swept, cell, seed)


def test_a_word_takes_all_cells_with_it_in_their_names_and_a_name_takes_its_cell(swept: Path) -> None:
    found = all_episodes(swept, "cavs=2")
    assert [(one.cell.swept["scenario.leg_length"], one.seed) for one in found] == [
        *(("100", 3), ("100", 4), ("120", 3), ("120", 4))
    ]
    whole = found[0].cell.folder
    assert {one.cell.folder for one in all_episodes(swept, whole, 3)} == {whole}
    with pytest.raises(RunFolderError, match="has no cell nothing; cells: intersection-codriving-full"):
        all_episodes(swept, "nothing")


def test_a_run_is_found_by_its_name_below_outputs(swept: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    shutil.copytree(swept, tmp_path / "outputs" / "run" / "first")
    monkeypatch.chdir(tmp_path)
    assert find_run(Path("first"))[0] == Path("outputs", "run", "first")
    with pytest.raises(RunFolderError, match="there is no run folder second; runs: outputs/run/first"):
        find_run(Path("second"))
    with pytest.raises(RunFolderError, match=r"outputs has no manifest.json, .*; runs in it: outputs/run/first"):
        find_run(Path("outputs"))
    shutil.copytree(swept, tmp_path / "outputs" / "ablate" / "first")
    with pytest.raises(RunFolderError, match="several runs are called first: outputs/ablate/first, outputs/run/first"):
        find_run(Path("first"))


def test_without_a_seed_the_first_that_was_driven_is_taken(single: Path) -> None:
    assert find_episode(single, None, None).seed == 0
    (find_episode(single, None, 0).folder / TRAJECTORY).unlink()
    assert find_episode(single, None, None).seed == 1


def test_an_episode_that_is_not_finished_says_how_to_go_on(single: Path) -> None:
    shutil.rmtree(find_episode(single, None, 1).folder)
    with pytest.raises(RunFolderError, match="no episode with seed 1; seeds: 0, 2"):
        find_episode(single, None, 1)
    for seed in (0, 2):
        shutil.rmtree(find_episode(single, None, seed).folder)
    with pytest.raises(RunFolderError, match=r"no episode of .* is finished yet; .* goes on with it"):
        find_episode(single, None, None)


@pytest.mark.parametrize(
    ("file", "content", "said"),
    [
        (TRAJECTORY, None, r"has no vehicle in trajectory\.csv, so there is nothing to show"),
        (DECISIONS, None, r"decisions\.jsonl is damaged \(it is missing\); .*run again"),
        (DECISIONS, "{", r"decisions\.jsonl is damaged"),
        (RECORD, "{}", r"record\.json is damaged"),
        (TRAJECTORY, "time\n", r"trajectory\.csv is damaged"),
    ],
)
def test_a_spoilt_episode_is_named(single: Path, file: str, content: str | None, said: str) -> None:
    episode = find_episode(single, None, 0)
    path = episode.folder / file
    path.unlink()
    if content is not None:
        path.write_text(content)
    with pytest.raises(RunFolderError, match=said):
        read_film(episode.folder, road_of(episode.cell))


def test_no_decisions_at_all_are_no_reason_not_to_show_it(single: Path) -> None:
    episode = find_episode(single, None, 0)
    (episode.folder / DECISIONS).write_text("")
    assert read_film(episode.folder, road_of(episode.cell)).frame(0.5).shape == (720, 1280, 4)


def test_a_manifest_without_settings_says_what_is_missing(single: Path) -> None:
    manifest = single / MANIFEST
    manifest.write_text(manifest.read_text().replace('"scenario.', '"scene.'))
    with pytest.raises(RunFolderError, match="does not say what scenario"):
        road_of(find_episode(single, None, 0).cell)


def _settings(single: Path, **values: object) -> Path:
    """The run with other settings in its manifest, as a stranger may have written them."""
    path = single / MANIFEST
    plain = json.loads(path.read_text())
    plain["cells"][0]["settings"] |= {key: json.dumps(value) for key, value in values.items()}
    path.write_text(json.dumps(plain))
    return single


CODE = {"_target_": "subprocess.Popen", "args": ["touch", "made"]}


@pytest.mark.parametrize(
    "values",
    [
        {"scenario._target_": "subprocess.Popen", "scenario.args": ["touch", "made"]},
        {"plugins": ["subprocess"], "scenario._target_": "subprocess.Popen"},
        {"scenario.road._target_": "subprocess.Popen", "scenario.road.args": ["touch", "made"]},
        {"scenario.start": CODE},
        {"scenario.start": [CODE, CODE]},
        {"scenario.leg_length._target_": "codriving.memory.store.MemoryStore", "scenario.leg_length.path": "made"},
        {"scenario.leg_length": "${oc.env:HOME}"},
        {"scenario" + ".deep" * 3000: 1},
    ],
)
def test_a_folder_of_a_stranger_chooses_no_code(
    single: Path, values: dict[str, object], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with contextlib.suppress(ConfigError, RunFolderError):
        assert road_of(find_episode(_settings(single, **values), None, 0).cell).name == Intersection.name
    assert not (tmp_path / "made").exists()


def test_classes_of_a_yaml_stay_where_a_manifest_has_values_for_them() -> None:
    node = {"_target_": "a.A", "part": {"_target_": "a.B", "x": 1}, "parts": [{"_target_": "a.C", "y": 1}], "z": 1}
    values = {"_target_": "evil.A", "part": {"_target_": "evil.B", "x": 2}, "parts": [{"y": 2}], "z": {"_target_": "e"}}
    assert _filled(node, values) == {
        "_target_": "a.A",
        "part": {"_target_": "a.B", "x": 2},
        "parts": [{"_target_": "a.C", "y": 2}],
        "z": {},
    }


def test_nothing_is_read_or_written_through_a_link_out_of_the_folder(single: Path, tmp_path: Path) -> None:
    episode = find_episode(single, None, 0).folder
    episode.rename(tmp_path / "elsewhere")
    episode.symlink_to(tmp_path / "elsewhere")
    with pytest.raises(RunFolderError, match=r"episodes/.*/0 is a symbolic link out of the run folder .*; put a copy"):
        find_episode(single, None, 0)
    tokens = [f"output={tmp_path}", "run=one", "episodes=3", "launcher=serial", "scenario.time_limit=1"]
    with pytest.raises(RunFolderError, match="is a symbolic link out of the run folder"):
        run_experiment([*tokens, "render=true"])
    assert not (tmp_path / "elsewhere" / "replay.mp4").exists()


def test_a_lock_that_leads_out_of_the_folder_empties_nothing(single: Path, tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("years of work")
    (single / ".lock").unlink()
    (single / ".lock").symlink_to(tmp_path / "thesis.tex")
    tokens = [f"output={tmp_path}", "run=one", "episodes=4", "launcher=serial", "scenario.time_limit=1"]
    with pytest.raises(RunFolderError, match=r"\.lock is a symbolic link out of the run folder"):
        run_experiment(tokens)
    assert (tmp_path / "thesis.tex").read_text() == "years of work"


@pytest.mark.parametrize("name", ["figures", "memory", "configs"])
def test_no_folder_of_a_run_leads_out_of_it(single: Path, name: str, tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    if (single / name).exists():
        shutil.rmtree(single / name)
    (single / name).symlink_to(tmp_path / "elsewhere")
    tokens = [f"output={tmp_path}", "run=one", "episodes=4", "launcher=serial", "scenario.time_limit=1"]
    with pytest.raises(RunFolderError, match=f"{name} is a symbolic link out of the run folder"):
        run_experiment(tokens)
    assert list((tmp_path / "elsewhere").iterdir()) == []
