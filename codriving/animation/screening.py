"""An episode from its first frame to its last."""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from math import ceil
from pathlib import Path
from typing import Any

from codriving.animation.camera import Camera
from codriving.animation.cards import natural
from codriving.animation.film import GIF, Frame, Reel, write_film
from codriving.animation.picture import Picture
from codriving.animation.replay import Replay
from codriving.datatypes.record import EpisodeRecord
from codriving.datatypes.road import Road
from codriving.datatypes.trajectory import Trajectory
from codriving.datatypes.vehicle import Kind
from codriving.geometry.road_map import road_map

WIDTH, HEIGHT = 1280.0, 720.0
"""Size of a frame at scale 1 [px]."""

_HOLD = 2.0
"""How long the last frame stands [s of film]."""

_SAMPLES = 8
"""Frames from which a GIF takes its colours."""


class Screening:
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
        self._replay = Replay(roads, trajectory, decisions, record.outcome)
        self.duration = self._replay.duration
        cavs = sorted((track.id for track in trajectory.tracks if track.kind is Kind.CAV), key=natural)
        method = f"{record.method} ({record.variant})" if record.variant else record.method
        title = (f"{record.scenario}, seed {record.seed}", f"{method}, reasoner: {record.reasoner}")
        self._picture = Picture(roads, tuple(cavs), title, WIDTH, HEIGHT, scale)
        self._camera = Camera(trajectory, roads, self._picture.view)

    def frame(self, time: float) -> Frame:
        """Draw one frame.

        Args:
            time: Simulated time [s].

        Returns:
            The frame (rows, columns, 4), RGBA; valid until the next one is drawn.
        """
        return self._picture.draw(self._replay.at(time), self._camera.at(time))

    def frames(self, rate: Fraction, speed: float) -> Iterator[Frame]:
        """Draw all frames of a film."""
        last = self.frame_count(rate, speed) - 1
        hold = ceil(_HOLD * rate)
        for k in range(last - hold):
            yield self.frame(min(k * speed / float(rate), self.duration))
        end = self.frame(self.duration)
        for _ in range(hold + 1):
            yield end

    def frame_count(self, rate: Fraction, speed: float) -> int:
        """Return how many frames a film has."""
        return ceil(self.duration / speed * float(rate) - 1e-9) + ceil(_HOLD * rate) + 1

    def write(
        self, path: Path, format: str, rate: Fraction, speed: float, frames: Iterator[Frame] | None = None
    ) -> int:
        """Write the film.

        Args:
            format: ``mp4`` or ``gif``.
            frames: ``frames(rate, speed)``, if somebody wants to count along.

        Raises:
            FilmError: If ffmpeg cannot be started or gives up.
        """
        rows, columns = self._picture.shape
        samples = []
        if format == GIF:
            samples = [self.frame(self.duration * k / (_SAMPLES - 1)).copy() for k in range(_SAMPLES)]
        return write_film(path, Reel(format, rate, rows, columns), frames or self.frames(rate, speed), samples)
