"""A stored episode as frames, and frames as a film: MP4 or GIF, by the ffmpeg that imageio-ffmpeg brings along."""

import os
import subprocess
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction
from math import ceil
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from codriving.animation import style
from codriving.animation.camera import Camera
from codriving.animation.content import StoredFrames
from codriving.animation.panel import natural
from codriving.animation.picture import Picture
from codriving.datatypes import EpisodeRecord, Kind, Road, Trajectory
from codriving.errors import FilmError
from codriving.geometry import road_map

MP4, GIF = "mp4", "gif"

Frame = NDArray[np.uint8]

# Players take colours of this size for those of BT.709 whether or not the file says so, so they are, and it says so.
_COLOURS = "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p"
_SAID = "setparams=color_primaries=bt709:color_trc=bt709:colorspace=bt709:range=tv"
_VIDEO = ("-codec:v", "libx264", "-preset", "veryfast", "-crf", "20", "-movflags", "+faststart", "-f", "mp4")
_ANIMATION = ("-filter_complex", "[0:v][1:v]paletteuse=dither=none:diff_mode=rectangle", "-loop", "0", "-f", "gif")
_SAME_BYTES = ("-map_metadata", "-1", "-fflags", "+bitexact", "-flags:v", "+bitexact")


@dataclass(frozen=True, slots=True)
class Reel:
    """The shape of a film."""

    format: str  # ``mp4`` or ``gif``
    rate: Fraction
    rows: int  # Height of a frame [px]
    columns: int  # Width of a frame [px]


def write_film(path: Path, reel: Reel, frames: Iterator[Frame], samples: Sequence[Frame] = ()) -> int:
    """Write a film; only one frame at a time is in memory."""
    with tempfile.TemporaryDirectory(prefix="codriving-") as folder:
        palette = Path(folder, "palette.png")
        if reel.format == GIF:
            _palette(samples).save(palette)
            # As a plain name: in the folder for temporary files a % would be read as a pattern of numbers.
            options: tuple[str, ...] = ("-f", "image2", "-pattern_type", "none", "-i", str(palette), *_ANIMATION)
        else:
            # Its colours are kept for two pixels by two, so both sides must be even.
            even = "pad=ceil(iw/2)*2:ceil(ih/2)*2," if reel.rows % 2 or reel.columns % 2 else ""
            options = ("-vf", f"{even}{_COLOURS},{_SAID}", *_VIDEO)
        size = f"{reel.columns}x{reel.rows}"
        raw = ("-f", "rawvideo", "-pixel_format", "rgba", "-video_size", size, "-framerate", str(reel.rate), "-i", "-")
        # Absolute: what comes before a colon would be a protocol, and what begins with a dash an option.
        return _encode([*raw, *options, *_SAME_BYTES, "-y", str(path.absolute())], frames)


def _encode(arguments: Sequence[str], frames: Iterator[Frame]) -> int:
    from imageio_ffmpeg import get_ffmpeg_exe

    with tempfile.TemporaryFile() as said:
        try:
            command = [get_ffmpeg_exe(), "-hide_banner", "-loglevel", "error", *arguments]
            # A session of its own: Ctrl-C is for us, and we end it.
            process = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=said, start_new_session=True
            )
        except (OSError, RuntimeError) as error:
            named = os.environ.get("IMAGEIO_FFMPEG_EXE")
            cure = "unset IMAGEIO_FFMPEG_EXE, which names it" if named else "install imageio-ffmpeg again"
            raise FilmError(f"cannot start ffmpeg: {error}; {cure}") from error
        try:
            count = _feed(process, frames)
        except BaseException:
            process.kill()
            process.wait()
            raise
        if code := process.wait():
            said.seek(0)
            words = " ".join(said.read().decode(errors="replace").split()) or f"exit code {code}"
            raise FilmError(f"ffmpeg gave up: {words}")
    return count


def _feed(process: "subprocess.Popen[bytes]", frames: Iterator[Frame]) -> int:
    """Hand over the frames; if ffmpeg is gone before the last one, its exit code tells."""
    assert process.stdin is not None
    count = 0
    with suppress(BrokenPipeError), process.stdin as pipe:
        for frame in frames:
            pipe.write(np.ascontiguousarray(frame).data)
            count += 1
    return count


def _palette(samples: Sequence[Frame]) -> Image.Image:
    """The 256 colours of a GIF: those of the style for certain, the others as they are met most."""
    named = [value for value in vars(style).values() if isinstance(value, str) and len(value) == 7 and value[0] == "#"]
    named += [stroke.colour for stroke in style.SEVERITIES.values()]
    fixed = [tuple(bytes.fromhex(colour[1:])) for colour in dict.fromkeys(named)]
    tall = np.concatenate([frame[::2, ::2, :3] for frame in samples])
    found = Image.fromarray(tall).quantize(256 - len(fixed), Image.Quantize.MEDIANCUT).getpalette() or []
    colours = [*fixed, *zip(found[0::3], found[1::3], found[2::3], strict=True)][:256]
    colours += [colours[0]] * (256 - len(colours))
    return Image.fromarray(np.array(colours, dtype=np.uint8).reshape(16, 16, 3))


def write_png(path: Path, frame: Frame) -> None:
    """Write a single frame.

    Raises:
        OSError: If it cannot be written.
    """
    Image.fromarray(frame).convert("RGB").save(path, format="PNG", optimize=True)


WIDTH, HEIGHT = 1280.0, 720.0  # Size of a frame at scale 1 [px]

_HOLD = 2.0  # How long the last frame stands [s of film]

_SAMPLES = 8  # Frames from which a GIF takes its colours


class EpisodeFilm:
    """Draws an episode from what was kept of it.

    Args:
        decisions: Lines of ``decisions.jsonl``.

    Attributes:
        duration: How long was driven [s].
    """

    def __init__(
        self,
        road: Road,
        trajectory: Trajectory,
        decisions: Sequence[Mapping[str, Any]],
        record: EpisodeRecord,
        scale: float = 1.0,
    ) -> None:
        roads = road_map(road)
        self._replay = StoredFrames(roads, trajectory, decisions, record.outcome)
        self.duration = self._replay.duration
        # In a flow there are too many for the panel.
        tracks = () if record.outcome.flow else trajectory.tracks
        cavs = sorted((track.id for track in tracks if track.kind is Kind.CAV), key=natural)
        method = f"{record.method} ({record.variant})" if record.variant else record.method
        title = (f"{record.scenario}, seed {record.seed}", f"{method}, reasoner: {record.reasoner}")
        self._picture = Picture(roads, tuple(cavs), title, WIDTH, HEIGHT, scale)
        self._camera = Camera(trajectory, roads, self._picture.view)

    def frame(self, time: float) -> Frame:
        """Draw one frame.

        Returns:
            The frame (rows, columns, 4), RGBA; valid until the next one is drawn.
        """
        return self._picture.draw(self._replay.at(time), self._camera.at(time))

    def frames(self, rate: Fraction, speed: float) -> Iterator[Frame]:
        """Draw all frames of a film."""
        hold = ceil(_HOLD * rate)
        for k in range(self.frame_count(rate, speed) - 1 - hold):
            yield self.frame(min(k * speed / float(rate), self.duration))
        yield from [self.frame(self.duration)] * (hold + 1)

    def frame_count(self, rate: Fraction, speed: float) -> int:
        """Return how many frames a film has."""
        return ceil(self.duration / speed * float(rate) - 1e-9) + ceil(_HOLD * rate) + 1

    def write(
        self, path: Path, format: str, rate: Fraction, speed: float, frames: Iterator[Frame] | None = None
    ) -> int:
        """Write the film.

        Args:
            format: ``mp4`` or ``gif``.
            frames: ``frames(rate, speed)``, for a caller that counts along.

        Raises:
            FilmError: If ffmpeg cannot be started or gives up.
        """
        rows, columns = self._picture.shape
        count = _SAMPLES if format == GIF else 0
        samples = [self.frame(self.duration * k / (_SAMPLES - 1)).copy() for k in range(count)]
        return write_film(path, Reel(format, rate, rows, columns), frames or self.frames(rate, speed), samples)
