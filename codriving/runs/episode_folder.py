"""The folder of one episode: record, trajectory, decisions, transcript, timing; written whole or not at all."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from codriving.datatypes import EpisodeRecord, Trajectory
from codriving.errors import RunFolderError
from codriving.runs.atomic import whole_folder
from codriving.runs.intact import DECISIONS, RECORD, SUMS, TRAJECTORY, sums_text
from codriving.runs.json_files import damaged, decode, encode, lines_text, parse_json, read_episode_text, read_lines
from codriving.runs.redaction import scrubbed, secrets_of, suspects
from codriving.runs.trajectory_file import trajectory_text

TRANSCRIPT = "transcript.jsonl"  # What a language model was asked and what it answered, one line a question

TIMING = "timing.json"  # What an episode cost in time, kept apart from all that must repeat to the byte

ERROR = "error.txt"

UNNAMED = ""  # Name of the metric of a record that release 0.1 wrote

EPISODES = "episodes"


def episode_folder(run: Path, cell: str, seed: int) -> Path:
    """Return the folder of one episode of a run."""
    return run / EPISODES / cell / str(seed)


@dataclass(frozen=True, slots=True)
class Timing:
    """Wall-clock time of one episode, and the computing time of its decisions."""

    seconds: float  # The whole episode [s]
    decisions: int
    decision_mean: float | None  # Mean time of a decision [s], or None without decisions
    decision_max: float | None  # Longest decision [s], or None without decisions
    # Mean CPU time of a decision, of the thread that decides [s]; None where it was not measured.
    decision_cpu_mean: float | None = None
    decision_cpu_max: float | None = None  # Largest CPU time of a decision [s], or None


def timing_of(seconds: float, decision_seconds: Sequence[float], decision_cpu: Sequence[float] = ()) -> Timing:
    """Sum up what was measured of an episode and of each of its decisions, in wall-clock and in CPU time [s]."""

    def mean_and_max(values: Sequence[float]) -> tuple[float | None, float | None]:
        return (sum(values) / len(values), max(values)) if values else (None, None)

    mean, longest = mean_and_max(decision_seconds)
    return Timing(seconds, len(decision_seconds), mean, longest, *mean_and_max(decision_cpu))


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
        record = replace(record, outcome=replace(record.outcome, message=scrubbed(record.outcome.message, secrets)))
        decisions, transcript, traceback = scrubbed((decisions, transcript, traceback), secrets)
    if traceback:
        # A plug-in may quote what it has read.
        hidden = secrets_of(suspects())
        record = replace(record, outcome=replace(record.outcome, message=scrubbed(record.outcome.message, hidden)))
        traceback = scrubbed(traceback, hidden)
    files = {RECORD: encode(record), DECISIONS: lines_text(DECISIONS, decisions)}
    if transcript:
        files[TRANSCRIPT] = lines_text(TRANSCRIPT, transcript)
    if trajectory is not None:
        files[TRAJECTORY] = trajectory_text(trajectory)
    # Of these two nothing depends on.
    files |= {SUMS: sums_text(files), TIMING: encode(timing)} | ({ERROR: traceback} if traceback else {})
    try:
        with whole_folder(folder) as partial:
            for name, text in files.items():
                (partial / name).write_text(text, encoding="utf-8", newline="")
    except OSError as error:
        raise RunFolderError(
            f"cannot write {folder}: {error.strerror or error}; make room or permit writing, then run again with the "
            "same run=<name>: finished episodes are kept"
        ) from error


def read_record(folder: Path) -> EpisodeRecord:
    """Read the record of one episode.

    Raises:
        RunFolderError: If it is missing or damaged; nothing is changed on disk.
    """
    path = folder / RECORD
    try:
        text = read_episode_text(path)
        # Release 0.1 wrote a single score, and not of which metric.
        if '\n  "score": ' in text:
            fields = parse_json(text)
            score = fields.pop("score")
            text = json.dumps({**fields, "scores": {} if score is None else {UNNAMED: score}})
        return decode(EpisodeRecord, text)
    except (ValueError, AttributeError, KeyError, RecursionError) as error:
        raise damaged(path, str(error)) from error


def read_decisions(folder: Path) -> tuple[dict[str, Any], ...]:
    """Read what was decided in one episode.

    Raises:
        RunFolderError: If it is missing, damaged or cannot be read.
    """
    return read_lines(folder / DECISIONS)


def read_transcript(folder: Path) -> tuple[dict[str, Any], ...]:
    """Read what a language model was asked in one episode; nothing where none was."""
    path = folder / TRANSCRIPT
    return read_lines(path) if path.exists() else ()


def read_timing(folder: Path) -> Timing | None:
    """Read the timing of one episode; None where there is none to read, since no result depends on it."""
    try:
        return decode(Timing, (folder / TIMING).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
