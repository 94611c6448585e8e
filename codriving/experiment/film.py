"""A film of each episode of a run, beside its record: ``render=true``."""

import traceback
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

from codriving.config import build
from codriving.datatypes import Ending, Scenario
from codriving.errors import DamagedEpisodeError, UserError
from codriving.experiment.stored import read_film
from codriving.experiment.worker import AfterEpisode, Unit
from codriving.runs import RECORD, TRAJECTORY, check_files, episode_folder, read_record, whole_file, write_text

FILM, FILM_ERROR = "replay.mp4", "replay-error.txt"

_RATE = Fraction(25)  # Frames a second


@dataclass(frozen=True)
class FilmEpisode(AfterEpisode):
    """Makes the film of an episode from what was kept of it; records are read and never written."""

    folder: Path
    configs: Mapping[str, Mapping[str, Any]]

    def path(self, unit: Unit) -> Path:
        """Where the film of an episode is, or will be."""
        return self._place(unit) / FILM

    def lacks(self, unit: Unit) -> bool:
        """Tell whether an episode that is saved has no film though there is something to show."""
        return (self._place(unit) / TRAJECTORY).exists() and not self.path(unit).exists()

    def saved(self, unit: Unit) -> Ending | None:
        """Tell how an episode ended that need not be driven again."""
        folder = self._place(unit)
        if not (folder / RECORD).exists():
            return None
        try:
            record = read_record(folder)
            check_files(folder, record)
        except DamagedEpisodeError:
            return None
        return None if record.outcome.ending is Ending.ERROR else record.outcome.ending

    def finish(self, unit: Unit) -> None:
        """Make the film of an episode that lacks one; ``replay-error.txt`` says why if that fails."""
        if not self.lacks(unit):
            return
        folder = self._place(unit)
        try:
            config = self.configs[unit.cell]
            show = read_film(folder, build(config["scenario"], Scenario, "scenario", config["plugins"]).road)
            # The unfinished film lies in the folder of the cell, which is swept when the run goes on.
            with whole_file(folder / FILM, beside=folder.parent) as partial:
                show.write(partial, "mp4", _RATE, 1.0)
            (folder / FILM_ERROR).unlink(missing_ok=True)
        except Exception as error:
            self.abandon(unit, error, "" if isinstance(error, UserError | OSError) else traceback.format_exc())

    def abandon(self, unit: Unit, error: Exception, trace: str = "") -> None:
        """Note why there is no film."""
        # On a full disk there is no room for this either; that the film is missing is reported all the same.
        with suppress(OSError):
            write_text(self._place(unit) / FILM_ERROR, trace or f"{error}\n")

    def _place(self, unit: Unit) -> Path:
        return episode_folder(self.folder, unit.cell, unit.seed)
