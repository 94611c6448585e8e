"""`codriving replay` from a run folder to a film, a GIF and a PNG; every mistake is one line."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from driven_run import driven_run
from imageio_ffmpeg import count_frames_and_secs
from PIL import Image
from typer.testing import CliRunner, Result

from codriving.cli.app import app
from codriving.runs.episode_folder import DECISIONS


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run with two episodes of 2 s."""
    return driven_run(tmp_path_factory.mktemp("outputs"), "episodes=2", "scenario.time_limit=2")


def call(*args: object) -> Result:
    return CliRunner().invoke(app, ["replay", *map(str, args)])


def test_a_film_is_written_beside_the_record(run: Path) -> None:
    result = call(run, "--episode", 1, "--fps", 5, "--scale", 0.5)
    assert result.exit_code == 0, result.output
    (film,) = run.glob("episodes/*/1/replay.mp4")
    assert result.stdout.startswith(f"Wrote {film}: 2.0 s of seed 1, 21 frames, ")
    assert count_frames_and_secs(str(film))[0] == 21


@pytest.mark.parametrize("how", [("--format", "gif"), ("--out", "film.gif"), ("--out", "film.GIF", "--format", "gif")])
def test_a_gif_is_asked_for_by_option_or_by_name(
    run: Path, how: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    result = call(run, *how, "--fps", 2, "--scale", 0.5, "--speed", 2)
    assert result.exit_code == 0, result.output
    path = Path(result.stdout.split("Wrote ")[1].split(": ")[0])
    with Image.open(path) as gif:
        assert (gif.format, gif.size) == ("GIF", (640, 360))
    path.unlink()


def test_a_moment_is_a_png_with_everything_on_it(run: Path, tmp_path: Path) -> None:
    path = tmp_path / "moment.png"
    result = call(run, "--frame", 0.5, "--out", path)
    assert result.exit_code == 0, result.output
    assert result.stdout == f"Wrote {path}: 0.5 s of seed 0.\n"
    with Image.open(path) as image:
        frame = np.asarray(image).astype(int)
    assert frame.shape == (720, 1280, 3)
    for colour in ((0x00, 0x72, 0xB2), (0xE6, 0x9F, 0x00), (0xCF, 0xD3, 0xD9), (0x1D, 0x21, 0x26)):
        assert (np.abs(frame[:, :896] - colour).max(-1) < 12).mean() > 0.0002, colour
    call(run, "--frame", 0.5, "--out", tmp_path)
    assert (tmp_path / "frame-0.5s.png").read_bytes() == path.read_bytes()


@pytest.mark.parametrize(
    ("args", "said"),
    [
        (("--episode", 9), "has no episode with seed 9; seeds: 0 to 1"),
        (("--cell", "merge"), "has no cell merge; cells: intersection-codriving-full"),
        (("--format", "avi"), "--format must be mp4 or gif, got avi"),
        (("--format", "gif", "--fps", 60), "--fps must be 1 to 50 for gif, got 60"),
        (("--fps", 0), "--fps must be 1 to 60 for mp4, got 0"),
        (("--speed", 0), "--speed must be 0.05 to 50, got 0"),
        (("--speed", "nan"), "--speed must be 0.05 to 50, got nan"),
        (("--scale", 9), "--scale must be 0.5 to 4, got 9"),
        (("--frame", 2.5), "--frame must be 0 to 2.0 s, when the episode ended, got 2.5"),
        (("--frame", -1), "--frame must be a time of 0 s or more, got -1"),
        (("--frame", 1, "--format", "gif"), "--frame writes a single PNG, so --format has no meaning with it"),
        (("--frame", 1, "--speed", 2), "--frame writes a single PNG, so --speed has no meaning with it"),
        (("--frame", 1, "--out", "x.mp4"), "--out ends in .mp4, but --frame writes a .png; make them agree"),
        (("--out", "x.png"), "--out ends in .png, but a film is .mp4 or .gif; make them agree"),
        (("--out", "x.gif", "--format", "mp4"), "--out ends in .gif, but --format is mp4; make them agree"),
        (("--out", "/nowhere/x.mp4"), "the folder /nowhere of --out does not exist"),
    ],
)
def test_a_users_mistake_is_one_line_and_exit_code_2(run: Path, args: tuple[object, ...], said: str) -> None:
    result = call(run, *args)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert said in result.stderr
    assert result.stderr.startswith("error: ")
    assert result.stderr.count("\n") == 1


def test_a_run_that_does_not_exist_is_answered_with_those_that_do(run: Path) -> None:
    result = call(run.parent / "secnd")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == f"error: there is no run folder {run.parent / 'secnd'}; runs: {run}\n"


def test_an_episode_without_decisions_is_named(run: Path, tmp_path: Path) -> None:
    copy = tmp_path / "copy"
    shutil.copytree(run, copy)
    (decisions,) = copy.glob(f"episodes/*/0/{DECISIONS}")
    decisions.unlink()
    result = call(copy, "--episode", 0)
    assert (result.exit_code, result.stderr.count("\n")) == (2, 1)
    assert f"{decisions} is damaged (it is missing)" in result.stderr


def test_a_film_that_cannot_be_written_leaves_nothing(
    run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", str(tmp_path / "no-ffmpeg"))
    result = call(run, "--out", tmp_path / "film.mp4")
    assert (result.exit_code, result.stderr.count("\n")) == (2, 1)
    assert "cannot start ffmpeg" in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_help_shows_an_example() -> None:
    result = CliRunner().invoke(app, ["replay", "--help"])
    assert "Example: codriving replay outputs/run/first --episode 3" in result.stdout


def test_a_file_is_no_run_folder(run: Path) -> None:
    result = call(run / "manifest.json")
    assert (result.exit_code, result.stdout) == (2, "")
    assert (
        result.stderr
        == f"error: {run / 'manifest.json'} is a file; give the folder of a run, or its name below outputs/\n"
    )


def test_runs_in_a_folder_are_looked_for_where_they_can_be(run: Path, tmp_path: Path) -> None:
    deep = tmp_path / "a" / "b" / "c" / "d" / "e"
    deep.mkdir(parents=True)
    shutil.copy(run / "manifest.json", deep)
    shutil.copytree(run, tmp_path / "outputs" / "run" / "first")
    result = call(tmp_path)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == (
        f"error: {tmp_path} has no manifest.json, so it is no run folder; runs in it: "
        f"{tmp_path / 'outputs' / 'run' / 'first'}\n"
    )


@pytest.mark.parametrize("name", ["[", "**", "*"])
def test_a_name_is_no_pattern(name: str, run: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(run.parents[2])
    result = call(name)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith(f"error: there is no run folder {name}; runs: ")
