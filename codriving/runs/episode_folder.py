"""The folder of one episode: record, trajectory, decisions, transcript, timing; written whole or not at all."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from codriving.datatypes.record import EpisodeRecord
from codriving.datatypes.trajectory import Trajectory
from codriving.errors import RunFolderError
from codriving.runs.atomic import whole_folder
from codriving.runs.decisions_file import DECISIONS, decisions_text
from codriving.runs.records import RECORD, record_text
from codriving.runs.redaction import scrubbed
from codriving.runs.timing import TIMING, Timing, timing_text
from codriving.runs.trajectory_file import TRAJECTORY, trajectory_text
from codriving.runs.transcript_file import TRANSCRIPT, transcript_text

ERROR = "error.txt"


def write_episode(
    folder: Path,
    record: EpisodeRecord,
    trajectory: Trajectory | None,
    decisions: Sequence[Mapping[str, object]],
    timing: Timing,
    traceback: str = "",
    transcript: Sequence[Mapping[str, object]] = (),
    secrets: Sequence[str] = (),
) -> None:
    """Write the folder of one episode, in place of an earlier attempt.

    Args:
        trajectory: What was driven, or None where nothing was.

    Raises:
        ValueError: If something cannot be written as it is (not finite, wrong type); nothing is left behind.
        RunFolderError: If the disk refuses.
    """
    if secrets:
        # A server may echo a key in an error or in an answer.
        message = str(scrubbed(record.outcome.message, secrets))
        record = replace(record, outcome=replace(record.outcome, message=message))
        decisions, transcript = _without(secrets, decisions), _without(secrets, transcript)
        traceback = str(scrubbed(traceback, secrets))
    files = {
        RECORD: record_text(record),
        DECISIONS: decisions_text(decisions),
        TIMING: timing_text(timing),
    }
    if transcript:
        files[TRANSCRIPT] = transcript_text(transcript)
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


def _without(secrets: Sequence[str], lines: Sequence[Mapping[str, object]]) -> list[Mapping[str, object]]:
    """Copies of lines in which no secret occurs."""
    return [{name: scrubbed(value, secrets) for name, value in line.items()} for line in lines]
