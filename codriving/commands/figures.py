"""``codriving figures``: figures of runs, and the space-time diagram of an episode, as PNG and SVG."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from codriving.errors import ConfigError, RunFolderError
from codriving.experiment import StoredEpisode, all_episodes, find_episode, find_run, read_episode, road_of
from codriving.pages import space_time_figure
from codriving.reports import (
    FIGURES,
    METHOD_CHOICE,
    PANELS,
    CellResults,
    DrawnRow,
    line_labels,
    panel_count,
    run_figures,
    stored_results,
)
from codriving.runs import CellEntry, check_files, read_record, whole_file

FOLDER = "figures"  # In the folder of the first run, where nothing else is said


@dataclass(frozen=True, slots=True)
class FigureOptions:
    """What is drawn, and where it is written."""

    out: Path | None = None  # A folder
    cell: str | None = None  # Name of a cell, or a part of it; None takes all
    episode: int | None = None  # Seed of the episode whose space-time diagram is drawn, and nothing else
    config_dir: Path | None = None
    only: str | None = None  # Name of the one figure that is drawn


def write_figures(runs: Sequence[Path], options: FigureOptions) -> str:
    """Write the figures of some runs, or that of an episode.

    Raises:
        UserError: If there is no such run, cell or episode, or nothing to draw, or a file cannot be written.
    """
    if options.out is not None and options.out.exists() and not options.out.is_dir():
        raise ConfigError(f"--out must be a folder, and {options.out} is a file; name another one")
    folder = options.out or find_run(runs[0])[0] / FOLDER
    notes: list[str] = []
    found = draw_episode(runs, options) if options.episode is not None else draw_runs(runs, options, notes)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, content in found.items():
            with whole_file(folder / name) as partial:
                partial.write_bytes(content)
    except OSError as error:
        raise RunFolderError(f"cannot write to {folder}: {error.strerror or error}; choose another --out") from error
    names = list(dict.fromkeys(name.rpartition(".")[0] for name in found))
    return "\n".join([f"Wrote to {folder}, as .png and .svg: {', '.join(names)}.", *notes])


def draw_episode(runs: Sequence[Path], options: FigureOptions) -> Mapping[str, bytes]:
    """Draw the space-time diagram of an episode."""
    if len(runs) > 1:
        raise ConfigError("--episode draws an episode of one run; name one")
    episode = find_episode(runs[0], options.cell, options.episode)
    record, trajectory = read_episode(episode)
    if record.outcome.flow is not None:
        raise ConfigError(f"{episode.folder} is of a flow, whose vehicles a space-time diagram has no room for")
    if trajectory is None or not trajectory.tracks:
        raise RunFolderError(f"nothing was driven in {episode.folder}, so there is nothing to draw; choose another")
    name = f"space-time-{episode.cell.folder}-{episode.seed}"
    return space_time_figure(trajectory, record, road_of(episode.cell, options.config_dir), name)


def draw_runs(runs: Sequence[Path], options: FigureOptions, notes: list[str]) -> Mapping[str, bytes]:
    """Draw all figures that there are of some runs.

    Args:
        notes: Takes what has to be said of what is left out.
    """
    if options.only is not None and options.only not in FIGURES:
        raise ConfigError(f"unknown figure {options.only!r:.100}; figures: {', '.join(FIGURES)}")
    folders = [find_run(run)[0] for run in runs]
    if len({folder.resolve() for folder in folders}) < len(folders):
        raise ConfigError("a run is named twice; name each run once")
    rows = [row for folder in folders for row in _rows(folder, options, len(folders) > 1)]
    wanted = [options.only] if options.only else list(FIGURES)
    found = run_figures(rows, ", ".join(dict.fromkeys(row.cell.metric for row in rows)), wanted)
    if options.only and not found:
        raise ConfigError(f"there is no figure {options.only} of {folders[0]}: {FIGURES[options.only].missing}")
    drawn = {name.rpartition(".")[0] for name in found}
    notes += [f"No {name}: {kind.missing}." for name, kind in FIGURES.items() if name not in drawn]
    panels = panel_count(rows)
    if panels > PANELS:
        notes.append(f"{panels - PANELS} of {panels} panels are left out; choose rows with --cell.")
    return found


def _rows(folder: Path, options: FigureOptions, several: bool) -> list[DrawnRow]:
    cells: dict[str, CellEntry] = {}
    episodes: dict[str, list[StoredEpisode]] = {}
    for episode in all_episodes(folder, options.cell):
        cells[episode.cell.folder] = episode.cell
        episodes.setdefault(episode.cell.folder, []).append(episode)
    results = [_results(cells[key], members) for key, members in episodes.items()]
    if any(record.outcome.flow is not None for cell in results for record in cell.records):
        raise ConfigError(f"{folder} is of flows, whose episodes neither succeed nor have PETs; its tables show them")
    labels = line_labels([(cell.name, cell, cell.swept.get(METHOD_CHOICE, "")) for cell in results])
    return [
        DrawnRow(f"{folder.resolve().name}: {label}" if several else label, _block(cell), cell)
        for label, cell in zip(labels, results, strict=True)
    ]


def _results(cell: CellEntry, episodes: Sequence[StoredEpisode]) -> CellResults:
    records = []
    for episode in episodes:
        records.append(record := read_record(episode.folder))
        check_files(episode.folder, record)
    return stored_results(records, cell.swept)


def _block(cell: CellResults) -> str:
    setting = [f"{key}={value}" for key, value in cell.swept.items() if key != METHOD_CHOICE]
    return "\n".join([cell.first.scenario, *setting])
