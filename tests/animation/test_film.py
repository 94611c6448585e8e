"""Films that players can play: as many frames as asked for, of the right size, in the right colours."""

import subprocess
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from crossing import Frame, crossing, episode, line, share
from imageio_ffmpeg import count_frames_and_secs, get_ffmpeg_exe
from PIL import Image

from codriving.animation.film import EpisodeFilm, Reel, write_film, write_png
from codriving.animation.style import ASPHALT, BLUE, GREEN, GROUND, PAPER, VERMILION
from codriving.datatypes.record import EpisodeRecord
from codriving.errors import FilmError

TRAJECTORY, OUTCOME = episode()


@pytest.fixture(scope="module")
def shown() -> EpisodeFilm:
    record = EpisodeRecord("crossing", "codriving", "full", "rules", 7, OUTCOME, None, (), 2, {})
    return EpisodeFilm(crossing().road, TRAJECTORY, [line(0.0), line(1.0)], record, 0.5)


def decoded(path: Path, rows: int = 360, columns: int = 640) -> list[Frame]:
    """The frames of a film as a player sees them."""
    command = [get_ffmpeg_exe(), "-v", "error", "-i", str(path), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    data = subprocess.run(command, capture_output=True, check=True).stdout
    return list(np.frombuffer(data, np.uint8).reshape(-1, rows, columns, 3))


def test_an_mp4_has_every_frame_and_holds_the_last(shown: EpisodeFilm, tmp_path: Path) -> None:
    path = tmp_path / "film"
    written = shown.write(path, "mp4", Fraction(10), 1.0)
    frames = decoded(path)
    # 3 s of driving with both ends, and 2 s in which the end stands.
    assert written == len(frames) == 3 * 10 + 1 + 2 * 10 == shown.frame_count(Fraction(10), 1.0)
    assert count_frames_and_secs(str(path))[1] == pytest.approx(5.1, abs=0.05)
    assert np.abs(frames[-1].astype(int) - frames[-15]).mean() < 1
    assert np.abs(frames[0].astype(int) - frames[-1]).mean() > 1


def test_colours_arrive_as_they_were_sent(shown: EpisodeFilm, tmp_path: Path) -> None:
    path = tmp_path / "film"
    shown.write(path, "mp4", Fraction(5), 1.0)
    frame = decoded(path)[0]
    for colour in (GROUND, PAPER, ASPHALT):
        assert share(frame, colour, 6) > 0.02
    assert share(frame, BLUE, 40) > 0.0005


def test_twice_the_speed_takes_half_the_frames(shown: EpisodeFilm) -> None:
    rate = Fraction(25)
    assert [shown.frame_count(rate, speed) - 51 for speed in (0.5, 1.0, 2.0)] == [150, 75, 38]
    assert sum(1 for _ in shown.frames(Fraction(3), 2.0)) == shown.frame_count(Fraction(3), 2.0)


def test_a_gif_repeats_and_keeps_its_colours(shown: EpisodeFilm, tmp_path: Path) -> None:
    path = tmp_path / "film"
    shown.write(path, "gif", Fraction(5), 1.0)
    with Image.open(path) as gif:
        assert (gif.format, gif.size, gif.info["loop"]) == ("GIF", (640, 360), 0)
        # Frames that are alike are one that stands longer.
        assert 10 < gif.n_frames <= shown.frame_count(Fraction(5), 1.0)
        total = 0
        for k in range(gif.n_frames):
            gif.seek(k)
            total += gif.info["duration"]
        last = np.asarray(gif.convert("RGB"))
    assert total == pytest.approx(1000 * shown.frame_count(Fraction(5), 1.0) / 5, abs=400)
    assert share(last, GROUND, 0) > 0.3
    assert share(last, GREEN, 3) > 0.0002
    assert np.abs(last.astype(int) - shown.frame(3.0)[..., :3]).mean() < 2


def test_odd_sides_are_made_even(tmp_path: Path) -> None:
    path = tmp_path / "film"
    frames = iter(np.full((2, 91, 161, 4), 255, dtype=np.uint8))
    assert write_film(path, Reel("mp4", Fraction(5), 91, 161), frames) == 2
    assert len(decoded(path, 92, 162)) == 2


@pytest.mark.parametrize("name", ["rel:1", "-x", "file:a", "%d", "a b'", "pipe:1", "übung"])
@pytest.mark.parametrize("format", ["mp4", "gif"])
def test_a_path_is_never_read_as_anything_else(
    name: str, format: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / name).mkdir()
    (tmp_path / "temporary%03d").mkdir()
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "temporary%03d"))
    frame = np.full((240, 320, 4), 255, np.uint8)
    path = Path(name, f"{name}.film")
    assert write_film(path, Reel(format, Fraction(5), 240, 320), iter([frame] * 3), [frame]) == 3
    assert path.stat().st_size > 500


def test_what_ffmpeg_says_is_passed_on(tmp_path: Path) -> None:
    frames = iter(np.zeros((40, 64, 64, 4), dtype=np.uint8))
    with pytest.raises(FilmError, match="No such file or directory"):
        write_film(tmp_path / "nowhere" / "film", Reel("mp4", Fraction(5), 64, 64), frames)


def test_an_error_while_drawing_ends_ffmpeg_and_passes_through(tmp_path: Path) -> None:
    def broken() -> Iterator[Frame]:
        yield np.zeros((64, 64, 4), dtype=np.uint8)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_film(tmp_path / "film", Reel("mp4", Fraction(5), 64, 64), broken())


def test_without_ffmpeg_there_is_a_clear_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", str(tmp_path / "no-ffmpeg"))
    with pytest.raises(FilmError, match=r"cannot start ffmpeg: .*; unset IMAGEIO_FFMPEG_EXE"):
        write_film(tmp_path / "film", Reel("mp4", Fraction(5), 64, 64), iter(()))


def test_a_png_always_has_the_same_bytes(shown: EpisodeFilm, tmp_path: Path) -> None:
    for name in ("one.png", "other.png"):
        shown.frame(2.0)
        write_png(tmp_path / name, shown.frame(0.7))
    assert (tmp_path / "one.png").read_bytes() == (tmp_path / "other.png").read_bytes()
    with Image.open(tmp_path / "one.png") as image:
        assert (image.size, image.mode) == ((640, 360), "RGB")
        assert share(np.asarray(image), VERMILION) > 0
