"""A run as data frames: its tables, and of its episodes PETs, decisions and trajectories."""

from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from codriving.api.frames import decision_frame, pet_frame, trajectory_frame
from codriving.api.page import page_of
from codriving.api.picture import DrawnFigure, pictures_of
from codriving.commands import FigureOptions, draw_episode, draw_runs
from codriving.errors import ConfigError, RunFolderError, require
from codriving.experiment import StoredEpisode, all_episodes, find_run
from codriving.runs import Manifest

if TYPE_CHECKING:
    from pandas import DataFrame

EPISODES, SUMMARY = "episodes.csv", "summary.csv"

# What a command makes beyond the tables of every run; the first one that is there is its table.
OWN = ("comparison.csv", "load.csv", "filters.csv", "models.csv", "ablation.csv", "learn.csv", "stress.csv")


@dataclass(frozen=True, eq=False)
class Result:
    """A run that is complete."""

    folder: Path
    episodes: "DataFrame"  # One row an episode
    summary: "DataFrame"  # One row a cell, with intervals
    table: "DataFrame"  # What the command makes: the comparison, the ablation, the learning curve; else the summary
    config_dir: Path | None = None  # A folder with YAMLs of the user's, whose roads figures are of

    @cached_property
    def manifest(self) -> Manifest:
        """What was driven, and with what."""
        return find_run(self.folder)[1]

    def pets(self, cell: str | None = None, episode: int | None = None, metrics: str | None = None) -> "DataFrame":
        """Give every PET [s], a row each.

        Args:
            cell: Name of a row of the table, or a part of the names of some; None takes all.
            episode: Seed; None takes all.
            metrics: By which metric; None takes the usual one, or the first that there is.
        """
        return pet_frame(self._found(cell, episode), metrics)

    def decisions(self, cell: str | None = None, episode: int | None = None) -> "DataFrame":
        """Give what each CAV decided at each step, a row each; ``entry`` is all that is known of it."""
        return decision_frame(self._found(cell, episode))

    def trajectories(self, cell: str | None = None, episode: int | None = None) -> "DataFrame":
        """Give every vehicle at every simulation step, a row each, in metres, seconds and radians."""
        return trajectory_frame(self._found(cell, episode))

    def figure(self, name: str, cell: str | None = None) -> DrawnFigure:
        """Draw one of the figures of ``codriving figures``, for instance ``"pets"``."""
        require(isinstance(name, str), f"a figure is asked for by its name, got {name!r:.100}")
        options = FigureOptions(cell=_name(cell), config_dir=self.config_dir, only=name)
        (picture,) = pictures_of(draw_runs([self.folder], options, [])).values()
        return picture

    def space_time(self, episode: int, cell: str | None = None) -> DrawnFigure:
        """Draw an episode: when each CAV was where along its route, and what ground others blocked for it."""
        options = FigureOptions(cell=_name(cell), episode=_seed(episode), config_dir=self.config_dir)
        (picture,) = pictures_of(draw_episode([self.folder], options)).values()
        return picture

    def _found(self, cell: str | None, episode: int | None) -> list[StoredEpisode]:
        episode = None if episode is None else _seed(episode)
        return all_episodes(self.folder, _name(cell), episode)

    def __repr__(self) -> str:
        return f"<{_heading(self)}; .table, .summary, .episodes, .pets(), .decisions(), .trajectories()>"

    def _repr_html_(self) -> str:
        return page_of(_heading(self), self.table)


def _name(cell: str | None) -> str | None:
    require(cell is None or isinstance(cell, str), f"cell must be the name of a row, or None, got {cell!r:.100}")
    return cell


def _seed(episode: object) -> int:
    if isinstance(episode, bool) or not isinstance(episode, int):
        raise ConfigError(f"episode must be a seed, a whole number, got {episode!r:.100}")
    return episode


def _heading(result: Result) -> str:
    rows, episodes = len(result.summary), len(result.episodes)
    return f"{episodes} episode{'s' * (episodes != 1)} in {rows} row{'s' * (rows != 1)}, {result.folder}"


def read_result(run: object, config_dir: Path | None = None) -> Result:
    """Read the tables of a run folder.

    Raises:
        RunFolderError: If it is none, or has no tables.
    """
    if not isinstance(run, str | Path):
        raise ConfigError(f"a run is a folder, or the name of one below outputs/, got {run!r:.100}")
    folder, _ = find_run(Path(run))
    names = {path.name for path in folder.glob("*.csv")}
    if missing := {EPISODES, SUMMARY} - names:
        raise RunFolderError(
            f"{folder} has no {min(missing)} yet; the command of the run with the same run=<name> goes on with it"
        )
    episodes, summary = _read(folder / EPISODES), _read(folder / SUMMARY)
    own = next((name for name in OWN if name in names), None)
    return Result(folder, episodes, summary, _read(folder / own) if own else summary, config_dir)


def _read(path: Path) -> "DataFrame":
    """Read a table; empty is not defined, but for a variant, which may be empty."""
    from pandas import read_csv, to_numeric

    try:
        frame: Any = read_csv(path, dtype=str, keep_default_na=False, na_values=[""])
    except (OSError, ValueError) as error:
        raise RunFolderError(f"{path} cannot be read ({error}); the command of the run writes it again") from error
    for key in frame.columns:
        with suppress(ValueError):
            frame[key] = to_numeric(frame[key])
    if "variant" in frame:
        frame["variant"] = frame["variant"].fillna("")
    return frame  # type: ignore[no-any-return]
