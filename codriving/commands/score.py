"""``codriving score``: recorded trajectories from anywhere, and the episodes of finished runs, by any metric."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from codriving.config import compose
from codriving.datatypes import Ending, EpisodeRecord, Road
from codriving.errors import ConfigError, RecordingError, RunFolderError
from codriving.experiment import all_episodes, lacks, read_episode, road_of, scorers_of
from codriving.metrics import Scorer, outcome_of, recorded_time
from codriving.recordings import read_recording
from codriving.reports import ScoredFiles, pet_table, print_scores, print_table, score_table
from codriving.runs import RECORD, TRAJECTORY, read_record, read_trajectory, write_text

UNJUDGED = "success: no vehicle that counts touches another. Whether all arrived, a recording does not say."

UNMARKED = "{names}: nothing says which vehicles are CAVs, so all of them count."

DRIVEN_PETS = (
    "PETs are taken from the trajectories alone, at the place where the second enters the ground of the first."
)

POOLED = "PETs and velocities are over all files, those without success too; further numbers are means of the files."

WITHOUT_ALONE = (
    "Delays, time_all and fairness need driving anew and are left out; the command of the run with this metric and the "
    "same run=NAME gives them."
)


@dataclass(frozen=True, slots=True)
class ScoreOptions:
    """What is made of the scores."""

    csv: Path | None = None
    pets: Path | None = None  # CSV of every PET
    config_dir: Path | None = None


@dataclass(frozen=True)
class Scored:
    """Files and episodes with their scores."""

    metric: str
    files: Sequence[ScoredFiles]
    notes: Sequence[str]  # What has to be said of them


def run_score(words: Sequence[str], options: ScoreOptions) -> None:
    """Score files and runs, print the table and write the CSV that is asked for.

    Args:
        words: Files, run folders or names of runs, and ``metrics=NAME`` with keys of the metric.

    Raises:
        UserError: If a file cannot be read, or a metric cannot score it.
    """
    for path in (options.csv, options.pets):
        if path is not None and not path.absolute().parent.is_dir():
            raise ConfigError(f"the folder of {path} does not exist; make it or choose another")
    scored = score_files(words, options.config_dir)
    print_table(print_scores(scored.files, scored.metric, scored.notes))
    for path, made in ((options.csv, score_table), (options.pets, pet_table)):
        if path is not None:
            _write(path, made(scored.files).csv())


def score_files(words: Sequence[str], config_dir: Path | None = None) -> Scored:
    """Score files and runs; nothing is printed."""
    sources = [Path(word) for word in words if not _is_override(word)]
    overrides = [word for word in words if _is_override(word)]
    if not sources:
        raise ConfigError("nothing to score; name files of trajectories, or a run folder")
    if "," in next((word for word in overrides if word.startswith("metrics=")), ""):
        raise ConfigError("score takes one metric at a time; call it again for the other one")
    for word in overrides:
        if word.partition("=")[0].lstrip("+").partition(".")[0] not in ("metrics", "plugins"):
            raise ConfigError(f"score takes no setting but those of metrics, got {word}; what was driven is as it is")
    (scorer,) = scorers_of(compose(overrides, config_dir)).values()
    files: list[ScoredFiles] = []
    notes: list[str] = []
    unmarked = []
    judged = False
    for source in sources:
        if _is_run(source):
            episodes, of_them = _run(source, scorer, config_dir)
            files += episodes
            notes += of_them
            continue
        found, said, marked, known = _file(source, scorer)
        files.append(found)
        notes += [f"{source}: {note}." for note in said]
        judged = judged or not known
        unmarked += [] if marked else [str(source)]
    recorded = any(not one.group for one in files)
    notes += [DRIVEN_PETS] if recorded and scorer.metric.name == "standard" else []
    notes += [UNJUDGED] if judged else []
    notes += [UNMARKED.format(names=", ".join(unmarked))] if unmarked else []
    notes += [POOLED] if len(files) > 1 else []
    return Scored(scorer.metric.name, files, notes)


def _is_override(word: str) -> bool:
    return "=" in word and not Path(word).exists()


def _is_run(source: Path) -> bool:
    # A name that is nowhere may be that of a run; it may hold dots.
    return source.is_dir() or not (source.exists() or source.suffix.lower() in (".csv", ".xml", ".gz", ".xlsx"))


def _file(path: Path, scorer: Scorer) -> tuple[ScoredFiles, Sequence[str], bool, bool]:
    """Score one file; gives what is to be said of it, whether CAVs are marked, and whether its outcome is known."""
    record = _record_beside(path)
    notes: tuple[str, ...] = ()
    if record is not None:
        trajectory, marked = read_trajectory(path.parent, record), True
        if trajectory is None or not trajectory.tracks:
            raise RecordingError(f"{path} has no row of a vehicle; give an episode in which something was driven")
        if record.outcome.flow is not None:
            raise RecordingError(f"{path} is of a flow, which is scored with its record; give the run folder")
        outcome = record.outcome
    else:
        if not path.exists():
            raise RecordingError(f"there is no file {path}; name one that exists")
        recording = read_recording(path)
        trajectory, notes, marked = recording.trajectory, recording.notes, recording.marked
        outcome = outcome_of(trajectory)
    score = scorer.metric.score_recording(trajectory, outcome)
    if score is None:
        raise ConfigError(
            f"metrics={scorer.metric.name} needs the road, which {path} does not say; choose metrics=standard or "
            "authors, or give the run folder"
        )
    found = ScoredFiles(str(path), (score,), len(trajectory.tracks), recorded_time(trajectory))
    return found, notes, marked, record is not None


def _record_beside(path: Path) -> EpisodeRecord | None:
    """The record of an episode whose trajectory it is; None of anything else."""
    if path.name != TRAJECTORY or not (path.parent / RECORD).is_file():
        return None
    return read_record(path.parent)


def _run(source: Path, scorer: Scorer, config_dir: Path | None) -> tuple[list[ScoredFiles], list[str]]:
    """Score the episodes of a run on the roads that they were driven on; nothing in its folder is changed."""
    found, roads, notes = list[ScoredFiles](), dict[str, Road](), list[str]()
    name, settings = scorer.metric.name, scorer.settings
    for episode in all_episodes(source):
        record, trajectory = read_episode(episode)
        where = f"{episode.cell.folder}/{episode.seed}"
        if record.outcome.ending is Ending.ERROR:
            notes.append(f"{where} ended in an error and has no score.")
            continue
        if record.outcome.flow is not None and not scorer.metric.flows:
            raise ConfigError(f"{where} is a flow, which metrics={name} does not measure; choose metrics=standard")
        if lacks(record, name, settings):
            if trajectory is None:
                raise RunFolderError(f"{episode.folder} has no trajectory to score; drive it again")
            if episode.cell.folder not in roads:
                roads[episode.cell.folder] = road_of(episode.cell, config_dir)
            score = scorer.score_stored(trajectory, record.outcome, roads[episode.cell.folder])
            if scorer.metric.against_alone:
                notes.append(WITHOUT_ALONE)
        else:
            score = record.scores[name]
        vehicles = len(record.participants)
        group = f"{source}: {episode.cell.folder}"
        found.append(ScoredFiles(f"{source}/{where}", (score,), vehicles, record.outcome.time, group))
    if not found:
        raise RunFolderError(f"no episode of {source} can be scored: all ended in errors; drive them again")
    return found, list(dict.fromkeys(notes))


def _write(path: Path, text: str) -> None:
    try:
        write_text(path, text)
    except OSError as error:
        raise RunFolderError(f"cannot write {path}: {error.strerror or error}; choose another name") from error
