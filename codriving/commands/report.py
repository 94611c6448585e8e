"""``codriving report``: runs as one page for a browser, in a single file."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from codriving.datatypes import Road
from codriving.errors import ConfigError, RunFolderError
from codriving.experiment import all_episodes, find_run, road_of
from codriving.pages import ReportedEpisode, ReportedRow, ReportedRun, report_page
from codriving.runs import check_files, read_record, write_text

NAME = "report.html"  # In the folder of the run, where nothing else is said

LONGEST = 150  # A longer name of several runs is said shorter: file systems take 255 [bytes]

REPLAYS = 40  # Episodes that can be replayed, where nothing else is said


@dataclass(frozen=True, slots=True)
class ReportOptions:
    """What is on the page, and where it is written."""

    out: Path | None = None  # The file, or a folder
    cell: str | None = None  # Name of a cell, or a part of it; None takes all
    replays: int | None = None
    config_dir: Path | None = None


def run_report(runs: Sequence[Path], options: ReportOptions) -> str:
    """Write the page of some runs.

    Raises:
        UserError: If there is no such run or cell, or the file cannot be written.
    """
    replays = REPLAYS if options.replays is None else options.replays
    if replays < 0:
        raise ConfigError(f"--replays must be 0 or more, got {replays}")
    folders = [find_run(run)[0] for run in runs]
    twice = [str(path) for path, count in Counter(folder.resolve() for folder in folders).items() if count > 1]
    if twice:
        raise ConfigError(f"{twice[0]} is named twice; name each run once")
    path = _target(options.out, folders)
    reported = [reported_run(*named, options, len(runs) > 1) for named in zip(folders, _names(folders), strict=True)]
    if all(len(run.rows) == 1 for run in reported):
        reported = [replace(run, rows=(replace(run.rows[0], alone=True),)) for run in reported]
    text = report_page(reported, replays)
    try:
        write_text(path, text)
    except OSError as error:
        raise RunFolderError(f"cannot write {path}: {error.strerror or error}; choose another --out") from error
    episodes = sum(len(row.episodes) for run in reported for row in run.rows)
    replayed = min(text.count('<script type="text/plain" id="e'), episodes)
    left = f", {replayed} of them to replay" if replayed < episodes else ""
    return f"Wrote {path}: {episodes} episode{'s' * (episodes > 1)}{left}, {len(text.encode()) / 1e6:.1f} MB."


def _target(out: Path | None, folders: Sequence[Path]) -> Path:
    name = NAME if len(folders) == 1 else f"report-{'-'.join(folder.resolve().name for folder in folders)}.html"
    if len(name.encode(errors="replace")) > LONGEST:
        name = f"report-of-{len(folders)}-runs.html"
    path = out / name if out and out.is_dir() else out or folders[0] / name
    if path.suffix.lower() not in (".html", ".htm"):
        raise ConfigError(f"--out ends in {path.suffix or 'nothing'}, but a page is .html; name it so")
    if not path.parent.is_dir():
        raise ConfigError(f"the folder {path.parent} of --out does not exist; make it or choose another")
    return path


def _names(folders: Sequence[Path]) -> list[str]:
    """What runs are called beside one another; where two have one name, with the folder that they are in."""
    names = [folder.resolve().name for folder in folders]
    return [
        name if names.count(name) == 1 else f"{folder.resolve().parent.name} {name}"
        for name, folder in zip(names, folders, strict=True)
    ]


def reported_run(folder: Path, name: str, options: ReportOptions, several: bool) -> ReportedRun:
    """Read the records of a run."""
    found: dict[str, list[ReportedEpisode]] = {}
    cells = {}
    for episode in all_episodes(folder, options.cell):
        cells[episode.cell.folder] = episode.cell
        record = read_record(episode.folder)
        check_files(episode.folder, record)
        found.setdefault(episode.cell.folder, []).append(ReportedEpisode(record, episode.folder))
    roads: dict[str, Road] = {}
    rows = []
    for key, cell in cells.items():
        # To compose a config takes as long as to read some episodes.
        scene = str(
            (
                cell.choices.get("scenario", cell.scenario),
                [pair for pair in cell.settings.items() if pair[0].startswith("scenario.")],
            )
        )
        roads[scene] = roads.get(scene) or road_of(cell, options.config_dir)
        rows.append(ReportedRow(cell, roads[scene], tuple(found[key]), name if several else ""))
    return ReportedRun(name, find_run(folder)[1], tuple(rows))
