"""The paper authors' own definitions, so that their published rows can be compared with."""

from codriving.datatypes.outcome import Ending, Outcome
from codriving.datatypes.parts import Metric
from codriving.datatypes.score import Pet, Score, TravelScore
from codriving.datatypes.trajectory import Track, Trajectory
from codriving.errors import ConfigError
from codriving.geometry.road_map import RoadMap
from codriving.metrics.encounters import Log, encounters


class AuthorsMetrics(Metric):
    """Success, PET and velocity as recovered from the authors' recordings of the intersection.

    Every vehicle counts, human drivers too, and all of the log, second laps too. Positions are taken relative to the
    origin, which is the middle of the intersection; on roads without one there, PETs mean little.

    Args:
        row_interval: Time between two rows of the log [s].
        box: Half the side of the square around the middle in which encounters count [m].
        distance: Distance between two centres below which they meet [m].
        rows: Number of rows over which the velocity is taken; None takes the whole log.

    Raises:
        ConfigError: If a number is not positive.
    """

    name = "authors"

    def __init__(
        self, row_interval: float = 0.2, box: float = 10.0, distance: float = 1.0, rows: int | None = 60
    ) -> None:
        for key, value in {"row_interval": row_interval, "box": box, "distance": distance, "rows": rows}.items():
            if value is not None and not value > 0:
                raise ConfigError(f"metrics.{key} must be > 0, got {value:g}")
        self.row_interval = row_interval
        self.box = box
        self.distance = distance
        self.rows = rows

    def score(self, trajectory: Trajectory, outcome: Outcome, road: RoadMap) -> Score:
        """Return the score of an episode."""
        stride = max(1, round(self.row_interval / trajectory.step))
        logs = [log for log in (_log(track, stride) for track in trajectory.tracks) if len(log.x)]
        return self.score_logs(logs, outcome.ending is Ending.SUCCESS, stride * trajectory.step)

    def score_logs(self, logs: list[Log], success: bool, row_interval: float) -> Score:
        """Return the score of logged vehicles.

        Args:
            row_interval: Time between two rows [s].
        """
        pets = []
        for met in encounters(logs, self.box, self.distance):
            order = (met.one, met.other) if met.row <= met.other_row else (met.other, met.one)
            pets.append(Pet(*order, "encounter", abs(met.row - met.other_row) * row_interval))
        travels = tuple(
            TravelScore(log.id, float(log.speed[: self.rows].mean()), (len(log.x) - 1) * row_interval, None)
            for log in logs
        )
        return Score(success, tuple(pets), travels)


def _log(track: Track, stride: int) -> Log:
    """Keep the rows of a track that fall on the rows of the authors' log."""
    skip = -track.first_step % stride
    rows = slice(skip, None, stride)
    return Log(track.id, track.x[rows], track.y[rows], track.speed[rows], (track.first_step + skip) // stride)
