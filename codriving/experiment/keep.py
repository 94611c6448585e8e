"""What becomes of a result: its folder in the run folder; done by the process that drove the episode."""

from dataclasses import dataclass
from pathlib import Path

from codriving.experiment.episodes.episode import EpisodeResult
from codriving.experiment.episodes.unit import Unit
from codriving.runs.episode_folder import timing_of, write_episode
from codriving.runs.redaction import secrets_of
from codriving.runs.run_folder import EPISODES


@dataclass(frozen=True)
class KeepEpisode:
    """Writes episodes under a run folder."""

    folder: Path
    variables: tuple[str, ...] = ()

    def __call__(self, unit: Unit, result: EpisodeResult) -> None:
        """Write one episode, whole or not at all.

        Raises:
            RunFolderError: If the disk refuses.
            ValueError: If the result cannot be written as it is.
        """
        write_episode(
            self.folder / EPISODES / unit.cell / str(unit.seed),
            result.record,
            result.trajectory,
            result.decisions,
            timing_of(result.seconds, result.decision_seconds, result.decision_cpu),
            result.traceback,
            result.transcript,
            secrets_of(self.variables),
        )
