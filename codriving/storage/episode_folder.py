"""The folder of one episode: record, trajectory, decisions, timing; written whole or not at all."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from codriving.datatypes.record import EpisodeRecord
from codriving.datatypes.trajectory import Trajectory
from codriving.errors import RunFolderError
from codriving.storage.atomic import whole_folder
from codriving.storage.decisions_file import DECISIONS, decisions_text
from codriving.storage.records import RECORD, record_text
from codriving.storage.timing import TIMING, Timing, timing_text
from codriving.storage.trajectory_file import TRAJECTORY, trajectory_text

ERROR = "error.txt"


def write_episode(
    folder: Path,
    record: EpisodeRecord,
    trajectory: Trajectory | None,
    decisions: Sequence[Mapping[str, object]],
    timing: Timing,
    traceback: str = "",
) -> None:
    """Write the folder of one episode, in place of an earlier attempt.

    Args:
        folder: Folder of the episode.
        record: Its result.
        trajectory: What was driven, or None where nothing was.
        decisions: One mapping a decision step.
        timing: Wall-clock times.
        traceback: Where it went wrong, if it did.

    Raises:
        ValueError: If something cannot be written as it is (not finite, wrong type); nothing is left behind.
        RunFolderError: If the disk refuses.
    """
    files = {
        RECORD: record_text(record),
        DECISIONS: decisions_text(decisions),
        TIMING: timing_text(timing),
    }
    if trajectory is not None:
        files[TRAJECTORY] = trajectory_text(trajectory)
    if traceback:
        files[ERROR] = traceback
    try:
        with whole_folder(folder) as partial:
            for name, text in files.items():
                (partial / name).write_text(text, encoding="utf-8", newline="")
    except OSError as error:
        raise RunFolderError(
            f"cannot write {folder}: {error.strerror or error}; make room or permit writing, then run again with the "
            "same run=<name>: finished episodes are kept"
        ) from error
