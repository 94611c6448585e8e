"""`render=true`: a film beside every record, and nothing else is different."""

from fractions import Fraction
from pathlib import Path

import pytest

import codriving.experiment.film
from codriving.commands.run import run_experiment
from codriving.datatypes.record import Ending
from codriving.errors import FilmError
from codriving.experiment.film import FILM, FILM_ERROR, FilmEpisode
from codriving.experiment.worker import Unit


@pytest.fixture(autouse=True)
def few_frames(monkeypatch: pytest.MonkeyPatch) -> None:
    """Films of a few frames; workers make full ones."""
    monkeypatch.setattr(codriving.experiment.film, "_RATE", Fraction(2))


SHORT = ("scenario.time_limit=1", "scenario.cavs=2", "scenario.hdvs=[0,0]")


def drive(output: Path, *tokens: str, name: str = "x", code: int = 0) -> Path:
    """Run a command with short episodes and give its run folder."""
    workers = () if any(token.startswith("workers=") for token in tokens) else ("launcher=serial",)
    assert run_experiment([*SHORT, *workers, f"output={output}", f"run={name}", *tokens]) == code
    return output / "run" / name


def results(folder: Path) -> dict[str, bytes]:
    """All files that must not depend on whether films are made."""
    ignored = {"timing.json", "timing.csv", "manifest.json", "config.yaml", FILM, ".lock"}
    files = [path for path in folder.rglob("*") if path.is_file() and path.name not in ignored]
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files if "configs" not in path.parts}


def films(folder: Path) -> list[Path]:
    return sorted(folder.glob(f"episodes/*/*/{FILM}"))


def test_each_episode_leaves_a_film_and_no_result_is_different(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with_films = drive(tmp_path, "episodes=2", "render=true", name="with")
    assert "2 films made" in capsys.readouterr().out
    without = drive(tmp_path, "episodes=2", name="without")
    assert len(films(with_films)) == 2
    assert all(b"ftyp" in film.read_bytes()[:16] for film in films(with_films))
    assert films(without) == []
    assert results(with_films) == results(without)


def test_what_is_finished_is_filmed_without_driving_again(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = drive(tmp_path, "episodes=2")
    before = {path: path.stat().st_mtime_ns for path in folder.rglob("record.json")}
    capsys.readouterr()
    assert drive(tmp_path, "episodes=2", "render=true") == folder
    out = capsys.readouterr().out
    assert "2 films made" in out
    assert "Nothing to do" not in out
    assert len(films(folder)) == 2
    assert {path: path.stat().st_mtime_ns for path in folder.rglob("record.json")} == before
    first, second = films(folder)
    second.unlink()
    made = first.stat().st_mtime_ns
    drive(tmp_path, "episodes=2", "render=true")
    assert second.exists()
    assert first.stat().st_mtime_ns == made
    capsys.readouterr()
    drive(tmp_path, "episodes=2", "render=true")
    assert capsys.readouterr().out.startswith("Nothing to do")


def test_workers_make_films_too(tmp_path: Path) -> None:
    folder = drive(tmp_path, "episodes=2", "render=true", "workers=2")
    assert len(films(folder)) == 2
    assert not list(folder.rglob(".partial-*"))


def test_a_film_that_fails_is_told_and_spoils_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def broken(*_: object) -> None:
        raise FilmError("ffmpeg gave up: no room")

    plain = results(drive(tmp_path, "episodes=2", name="plain"))
    capsys.readouterr()
    with monkeypatch.context() as patch:
        patch.setattr(codriving.experiment.film, "read_film", broken)
        folder = drive(tmp_path, "episodes=2", "render=true", code=1)
    out = capsys.readouterr().out
    assert f"2 episodes could not be filmed (see {folder}/episodes/" in out
    assert "Try again with: codriving run" in out
    notes = list(folder.rglob(FILM_ERROR))
    assert [note.read_text() for note in notes] == ["ffmpeg gave up: no room\n"] * 2
    after = {name: data for name, data in results(folder).items() if FILM_ERROR not in name}
    assert after == plain
    drive(tmp_path, "episodes=2", "render=true")
    assert len(films(folder)) == 2
    assert not list(folder.rglob(FILM_ERROR))


def test_a_bug_in_the_drawing_leaves_its_traceback_and_the_record(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object) -> None:
        raise RuntimeError("a bug")

    monkeypatch.setattr(codriving.experiment.film, "read_film", broken)
    folder = drive(tmp_path, "episodes=1", "render=true", code=1)
    (note,) = folder.rglob(FILM_ERROR)
    assert "Traceback" in note.read_text()
    assert (note.parent / "record.json").exists()


def test_an_episode_without_a_step_needs_no_film(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    crowded = ("scenario.cavs=12", "scenario.hdvs=[6,6]", "scenario.start=[20,75]", "seed=0")
    folder = drive(tmp_path, "episodes=1", "render=true", *crowded, code=1)
    assert "1 episode ended in an error" in capsys.readouterr().out
    assert films(folder) == []


def test_only_what_ended_well_is_kept(tmp_path: Path) -> None:
    folder = drive(tmp_path, "episodes=1")
    (cell,) = (path.name for path in (folder / "episodes").iterdir())
    film = FilmEpisode(folder, {})
    assert film.saved(Unit(cell, 0)) is Ending.TIMEOUT
    assert film.saved(Unit(cell, 1)) is None
    record = folder / "episodes" / cell / "0" / "record.json"
    record.write_text(record.read_text().replace('"timeout"', '"error"'))
    assert film.saved(Unit(cell, 0)) is None
