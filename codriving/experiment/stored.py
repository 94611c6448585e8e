"""Stored episodes: found in a run folder by cell and seed, and read back without the simulator."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from glob import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from codriving.config import SUITE, TARGET, build, check_choice, choices, compose
from codriving.datatypes import EpisodeRecord, Road, Scenario, Trajectory
from codriving.errors import RunFolderError
from codriving.runs import (
    EPISODES,
    MANIFEST,
    TRAJECTORY,
    CellEntry,
    Manifest,
    check_files,
    nested,
    read_decisions,
    read_manifest,
    read_record,
    read_trajectory,
    settings_of,
    within,
)

if TYPE_CHECKING:
    from codriving.animation import EpisodeFilm


@dataclass(frozen=True, slots=True)
class StoredEpisode:
    """An episode of a run folder."""

    cell: CellEntry
    seed: int
    folder: Path


def find_run(run: Path) -> tuple[Path, Manifest]:
    """Find a run folder by its path, or by its name below ``outputs/``."""
    named = sorted(Path("outputs").glob(f"*/{escape(str(run))}")) if len(run.parts) == 1 and not run.exists() else []
    places = [run] if run.exists() else [place for place in named if (place / MANIFEST).is_file()]
    if len(places) > 1:
        raise RunFolderError(f"several runs are called {run}: {_names(places)}; give the path of one")
    if not places:
        nearby = sorted(p.parent for p in (run.parent if run.parent.is_dir() else Path()).glob(f"*/{MANIFEST}"))
        nearby = nearby or sorted(p.parent for p in Path("outputs").glob(f"*/*/{MANIFEST}"))
        raise RunFolderError(f"there is no run folder {run}; runs: {_names(nearby)}")
    if not places[0].is_dir():
        raise RunFolderError(f"{places[0]} is a file; give the folder of a run, or its name below outputs/")
    if (manifest := read_manifest(places[0])) is None:
        # No deeper than outputs/<experiment>/<run>: the folder may be that of a whole disk.
        deep = [f"{'*/' * depth}{MANIFEST}" for depth in (1, 2, 3)]
        inside = sorted(path.parent for pattern in deep for path in places[0].glob(pattern))
        raise RunFolderError(f"{places[0]} has no {MANIFEST}, so it is no run folder; runs in it: {_names(inside)}")
    return places[0], manifest


def find_episode(
    run: Path, cell: str | None, seed: int | None, suite: str | None = None, config_dir: Path | None = None
) -> StoredEpisode:
    """Find an episode, of the cell that is named or of the one that was driven in the world of a suite."""
    run, manifest = find_run(run)
    cells = manifest.cells if suite is None else _driven_in(run, manifest.cells, suite, config_dir)
    entry = _cell(run, cells, cell)
    episodes, seeds = _seeds(run, entry)
    if not seeds:
        raise RunFolderError(
            f"no episode of {entry.folder} in {run} is finished yet; the command of the run with the same run=<name> "
            "goes on with it"
        )
    if seed is not None and seed not in seeds:
        raise RunFolderError(f"{entry.folder} in {run} has no episode with seed {seed}; seeds: {_ranges(seeds)}")
    driven = [s for s in seeds if (episodes / str(s) / TRAJECTORY).exists()]
    chosen = [*driven, *seeds][0] if seed is None else seed
    return StoredEpisode(entry, chosen, within(run, episodes / str(chosen)))


def _seeds(run: Path, cell: CellEntry) -> tuple[Path, list[int]]:
    """The folder of the episodes of a cell, and their seeds."""
    episodes = within(run, run / EPISODES / cell.folder)
    names = [path.name for path in episodes.glob("*") if path.is_dir()]
    return episodes, sorted(int(name) for name in names if name.isascii() and name.isdigit())


def all_episodes(run: Path, cell: str | None = None, seed: int | None = None) -> list[StoredEpisode]:
    """Find the episodes of a run, or those of the cells with a word in their names, or with one seed.

    Raises:
        RunFolderError: If there is none.
    """
    run, manifest = find_run(run)
    entries = manifest.cells if cell is None else _cells(run, manifest.cells, cell)
    found = []
    for entry in entries:
        episodes, seeds = _seeds(run, entry)
        found += [StoredEpisode(entry, s, within(run, episodes / str(s))) for s in seeds if seed in (None, s)]
    if not found:
        which = "" if seed is None else f" with seed {seed}"
        raise RunFolderError(f"{run} has no finished episode{which}; the command of the run goes on with it")
    return found


def read_episode(episode: StoredEpisode) -> tuple[EpisodeRecord, Trajectory | None]:
    """Read the record and what was driven; None where that is nothing.

    Raises:
        RunFolderError: If a file is damaged or missing.
    """
    record = read_record(episode.folder)
    check_files(episode.folder, record)
    return record, read_trajectory(episode.folder, record)


def read_film(folder: Path, road: Road, scale: float = 1.0) -> "EpisodeFilm":
    """Read an episode for its pictures."""
    from codriving.animation import EpisodeFilm

    record = read_record(folder)
    trajectory = read_trajectory(folder, record)
    if trajectory is None or not trajectory.tracks:
        why = f"it ended in an error ({record.outcome.message})" if record.outcome.message else "nothing was driven"
        raise RunFolderError(f"{folder} has no vehicle in {TRAJECTORY}, so there is nothing to show: {why}")
    return EpisodeFilm(road, trajectory, read_decisions(folder), record, scale)


def road_of(cell: CellEntry, config_dir: Path | None = None) -> Road:
    """Build the road of a cell: the class is that of the scenario's YAML, only the values are from the manifest."""
    try:
        values = nested({key: value for key, value in cell.settings.items() if key.startswith("scenario.")})
    except (ValueError, RecursionError) as error:
        raise RunFolderError(f"the manifest is damaged: settings of {cell.folder}: {error}; drive it again") from error
    if not values:
        raise RunFolderError(f"the manifest does not say what scenario {cell.folder} was; drive it again")
    name = cell.choices.get("scenario", cell.scenario)
    if name not in (known := choices("scenario", config_dir)):
        raise RunFolderError(
            f"{cell.folder} was driven in the scenario {name}, which is none of {', '.join(known)}; name the folder of "
            "its YAML with --config-dir"
        )
    config = compose([f"scenario={name}"], config_dir)
    try:
        node = _filled(config["scenario"], values["scenario"])
        return build(node, Scenario, "scenario", config["plugins"]).road
    except RecursionError as error:
        raise RunFolderError(
            f"the manifest is damaged: settings of {cell.folder} are too deep; drive it again"
        ) from error


def _filled(node: object, values: object) -> Any:  # noqa: ANN401 - any plain value
    """A node of a YAML with the values of a manifest, of which none is taken for a class."""
    if isinstance(values, Mapping):
        own = node if isinstance(node, Mapping) else {}
        return {**own, **{key: _filled(own.get(key), value) for key, value in values.items() if key != TARGET}}
    if isinstance(values, list):
        nodes = node if isinstance(node, list) and len(node) == len(values) else [None] * len(values)
        return [_filled(*pair) for pair in zip(nodes, values, strict=True)]
    return values


def _driven_in(run: Path, cells: Sequence[CellEntry], suite: str, config_dir: Path | None) -> list[CellEntry]:
    """Keep the cells whose environment is that of a suite."""
    check_choice(SUITE, suite, config_dir)
    settings = settings_of(compose([f"{SUITE}={suite}"], config_dir))
    found = [cell for cell in cells if _environment(cell.settings) == _environment(settings)]
    if not found:
        raise RunFolderError(f"nothing in {run} was driven in the world of {SUITE}={suite}; leave it out")
    return found


def _environment(settings: Mapping[str, str]) -> dict[str, str]:
    return {key: value for key, value in settings.items() if key.startswith("environment.")}


def _cell(run: Path, cells: Sequence[CellEntry], name: str | None) -> CellEntry:
    folders = [cell.folder for cell in cells]
    if name is None:
        if len(folders) > 1:
            raise RunFolderError(f"{run} holds {len(folders)} cells; choose one with --cell: {', '.join(folders)}")
        return cells[0]
    matches = _cells(run, cells, name)
    if len(matches) > 1:
        raise RunFolderError(f"several cells of {run} are called like {name}: {', '.join(c.folder for c in matches)}")
    return matches[0]


def _cells(run: Path, cells: Sequence[CellEntry], name: str) -> list[CellEntry]:
    """The cell of a name, else those with the name in theirs."""
    matches = [cell for cell in cells if cell.folder == name] or [cell for cell in cells if name in cell.folder]
    if not matches:
        raise RunFolderError(f"{run} has no cell {name}; cells: {', '.join(cell.folder for cell in cells)}")
    return matches


def _names(paths: list[Path]) -> str:
    shown = ", ".join(str(path) for path in paths[-10:])
    return f"{shown} and {len(paths) - 10} more" if len(paths) > 10 else shown or "none"


def _ranges(seeds: list[int]) -> str:
    """``0 to 19, 25`` for rising numbers."""
    parts: list[list[int]] = []
    for seed in seeds:
        if parts and seed == parts[-1][-1] + 1:
            parts[-1].append(seed)
        else:
            parts.append([seed])
    shown = [str(p[0]) if len(p) == 1 else f"{p[0]} to {p[-1]}" for p in parts[:20]]
    return ", ".join(shown) + (", ..." if len(parts) > 20 else "")
