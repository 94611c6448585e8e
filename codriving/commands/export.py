"""``codriving export``: the episodes of a run in the layouts of other programs."""

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from codriving.commands.sft import FILE as SFT_FILE
from codriving.commands.sft import refuse_measured, sft_text
from codriving.config import compose
from codriving.datatypes import EpisodeRecord, Trajectory
from codriving.errors import ConfigError, RunFolderError
from codriving.experiment import StoredEpisode, all_episodes, find_run, lacks, read_episode, road_of, scorers_of
from codriving.recordings import fcd_text, interhub_rows, tidy_text
from codriving.runs import write_text

LAYOUTS = ("fcd", "interhub", "csv", "sft")

FOLDER = "exported"  # Below the run, where nothing else is said


@dataclass(frozen=True, slots=True)
class ExportOptions:
    """What is exported, and where to."""

    to: str
    cell: str | None = None  # Name of a cell, or a part of it; None takes all
    episode: int | None = None  # Seed; None takes all
    out: Path | None = None  # A folder
    config_dir: Path | None = None


def run_export(run: Path, options: ExportOptions) -> str:
    """Write the episodes of a run, a file each; of InterHub one table.

    Raises:
        UserError: If there is no such run, layout or episode, or a file cannot be written.
    """
    if options.to not in LAYOUTS:
        raise ConfigError(f"--to must be {', '.join(LAYOUTS[:-1])} or {LAYOUTS[-1]}, got {options.to}")
    if options.out is not None and options.out.exists() and not options.out.is_dir():
        raise ConfigError(f"--out must be a folder, and {options.out} is a file; name another one")
    folder = options.out or find_run(run)[0] / FOLDER
    chosen = all_episodes(run, options.cell, options.episode)
    if options.to == "sft":
        refuse_measured(chosen)
    driven = [(episode, *read_episode(episode)) for episode in chosen]
    moved = [
        (e, record, trajectory) for e, record, trajectory in driven if trajectory is not None and trajectory.tracks
    ]
    if not moved:
        raise RunFolderError(f"nothing was driven in the episodes of {run} that were chosen; choose others")
    if options.to == "interhub":
        files = {"interhub.csv": _interhub(moved, options.config_dir)}
    elif options.to == "sft":
        files = {SFT_FILE: sft_text([(episode, record) for episode, record, _ in moved])}
    else:
        ending, text = (".fcd.xml", fcd_text) if options.to == "fcd" else (".csv", tidy_text)
        files = {f"{e.cell.folder}-{e.seed}{ending}": text(trajectory) for e, _, trajectory in moved}
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, content in files.items():
            write_text(folder / name, content)
    except OSError as error:
        raise RunFolderError(f"cannot write to {folder}: {error.strerror or error}; choose another --out") from error
    first = next(iter(files))
    where = folder / first if len(files) == 1 else f"{len(files)} files to {folder}, {first} and others"
    left = f", {len(driven) - len(moved)} without a vehicle left out" if len(moved) < len(driven) else ""
    return f"Wrote {where}: {len(moved)} episode{'s' * (len(moved) > 1)}{left}."


def _interhub(driven: Sequence[tuple[StoredEpisode, EpisodeRecord, Trajectory]], config_dir: Path | None) -> str:
    """A row for each PET of ``metrics=standard``, that of the record or taken anew."""
    (scorer,) = scorers_of(compose([], config_dir)).values()
    rows: list[Mapping[str, str | int | float | None]] = []
    for episode, record, trajectory in driven:
        if lacks(record, scorer.metric.name, scorer.settings):
            score = scorer.score_stored(trajectory, record.outcome, road_of(episode.cell, config_dir))
        else:
            score = record.scores[scorer.metric.name]
        rows += interhub_rows(trajectory, score.pets, episode.cell.folder, episode.seed)
    if not rows:
        raise RunFolderError("no two vehicles of these episodes have a PET, so there is no interaction to write")
    out = io.StringIO()
    writer = csv.DictWriter(out, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows({key: "" if value is None else value for key, value in row.items()} for row in rows)
    return out.getvalue()
