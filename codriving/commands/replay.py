"""A stored episode as a film or a picture: ``codriving replay``."""

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

from codriving.config import SUITE
from codriving.errors import ConfigError, RunFolderError
from codriving.experiment import find_episode, read_film, road_of
from codriving.runs import whole_file

if TYPE_CHECKING:
    from codriving.animation import Frame

FORMATS = ("mp4", "gif")
# Most frames a second; a GIF counts in hundredths of a second, and viewers slow down what is shorter than two.
FASTEST = {"mp4": 60.0, "gif": 50.0}

RATES = {"mp4": 25.0, "gif": 10.0}  # Frames a second, if none are asked for

SPEEDS, SCALES = (0.05, 50.0), (0.5, 4.0)


@dataclass(frozen=True, slots=True)
class ReplayOptions:
    """How an episode is to be shown."""

    cell: str | None = None  # Name of the cell, or a part of it; None if there is but one
    episode: int | None = None  # Seed; None takes the first
    format: str | None = None  # ``mp4`` or ``gif``; None goes by the name of the file, and is a film otherwise
    out: Path | None = None  # The file; None puts it beside the record
    speed: float | None = None
    fps: float | None = None  # Frames a second of film; None takes 25, and 10 for a GIF
    scale: float = 1.0
    frame: float | None = None  # Simulated time of a single picture [s]; None makes a film
    config_dir: Path | None = None
    overrides: tuple[str, ...] = ()  # ``suite=NAME`` or nothing


def run_replay(run: Path, options: ReplayOptions) -> str:
    """Write a film or a picture of a stored episode.

    Raises:
        UserError: If there is no such episode, the options cannot be, or the file cannot be written.
    """
    kind = _kind(options)
    rate, speed = _pace(options, kind)
    episode = find_episode(run, options.cell, options.episode, _suite(options), options.config_dir)
    name = f"replay.{kind}" if options.frame is None else f"frame-{options.frame:g}s.png"
    path = _target(options, episode.folder / name)
    show = read_film(episode.folder, road_of(episode.cell, options.config_dir), options.scale)
    if options.frame is not None and options.frame > show.duration:
        raise ConfigError(f"--frame must be 0 to {show.duration:.1f} s, when the episode ended, got {options.frame:g}")
    try:
        with whole_file(path) as partial:
            if options.frame is not None:
                from codriving.animation import write_png

                write_png(partial, show.frame(options.frame))
                return f"Wrote {path}: {options.frame:g} s of seed {episode.seed}."
            frames = _counted(show.frames(rate, speed), show.frame_count(rate, speed))
            count = show.write(partial, kind, rate, speed, frames)
            size = partial.stat().st_size / 1e6
    except OSError as error:
        raise RunFolderError(f"cannot write {path}: {error.strerror or error}; choose another --out") from error
    return f"Wrote {path}: {show.duration:.1f} s of seed {episode.seed}, {count} frames, {size:.1f} MB."


def _suite(options: ReplayOptions) -> str | None:
    """The suite in whose world the row to show was driven; None if none is named."""
    names = [token.partition("=") for token in options.overrides]
    if len(names) > 1 or any(key != SUITE or not name for key, _, name in names):
        raise ConfigError(
            f"replay takes no setting but one {SUITE}=NAME, which chooses a row, got {' '.join(options.overrides)}; "
            "the run folder says with which settings it was driven"
        )
    return names[0][2] if names else None


def _kind(options: ReplayOptions) -> str:
    """The format, from the option or from the name of the file; ``png`` for a single picture."""
    suffix = options.out.suffix.lower().removeprefix(".") if options.out and not options.out.is_dir() else ""
    if options.frame is not None:
        for name, value in (("--format", options.format), ("--speed", options.speed), ("--fps", options.fps)):
            if value is not None:
                raise ConfigError(f"--frame writes a single PNG, so {name} has no meaning with it; leave one out")
        if not options.frame >= 0:
            raise ConfigError(f"--frame must be a time of 0 s or more, got {options.frame:g}")
        kind = "png"
    else:
        if options.format is not None and options.format not in FORMATS:
            raise ConfigError(f"--format must be {' or '.join(FORMATS)}, got {options.format}")
        kind = options.format or (suffix if suffix in FORMATS else "mp4")
    if suffix and suffix != kind:
        wanted = "--frame writes a .png" if kind == "png" else f"a film is .{' or .'.join(FORMATS)}"
        if options.format:
            wanted = f"--format is {kind}"
        raise ConfigError(f"--out ends in .{suffix}, but {wanted}; make them agree")
    return kind


def _pace(options: ReplayOptions, kind: str) -> tuple[Fraction, float]:
    """Frames a second of film, and seconds of driving a second of film."""
    if not SCALES[0] <= options.scale <= SCALES[1]:
        raise ConfigError(f"--scale must be {SCALES[0]:g} to {SCALES[1]:g}, got {options.scale:g}")
    if kind == "png":
        return Fraction(1), 1.0
    speed = 1.0 if options.speed is None else options.speed
    if not SPEEDS[0] <= speed <= SPEEDS[1]:
        raise ConfigError(f"--speed must be {SPEEDS[0]:g} to {SPEEDS[1]:g}, got {speed:g}")
    fps = RATES[kind] if options.fps is None else options.fps
    if not 1.0 <= fps <= FASTEST[kind]:
        raise ConfigError(f"--fps must be 1 to {FASTEST[kind]:g} for {kind}, got {fps:g}")
    return Fraction(fps).limit_denominator(1001), speed


def _target(options: ReplayOptions, default: Path) -> Path:
    path = options.out / default.name if options.out and options.out.is_dir() else options.out or default
    if not path.parent.is_dir():
        raise ConfigError(f"the folder {path.parent} of --out does not exist; make it or choose another")
    return path


def _counted(frames: "Iterator[Frame]", count: int) -> "Iterator[Frame]":
    """Show on a terminal how far it is."""
    if not sys.stderr.isatty():
        yield from frames
        return
    from rich.console import Console
    from rich.progress import track

    yield from track(frames, "drawing", total=count, console=Console(file=sys.stderr), transient=True)
