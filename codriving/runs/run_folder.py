"""The folder of one run: opened under a lock, checked against the config, resumed where it was left."""

from collections.abc import Collection, Mapping
from datetime import datetime
from pathlib import Path
from typing import Self

from codriving.datatypes.record import EpisodeRecord
from codriving.errors import RunFolderError
from codriving.runs.atomic import PARTIAL, sweep, write_text
from codriving.runs.continuation import continued
from codriving.runs.lock import FolderLock
from codriving.runs.manifest import MANIFEST, CellEntry, Manifest, manifest_text, read_manifest
from codriving.runs.records import RECORD, damaged, read_record

CONFIG = "config.yaml"
CONFIGS = "configs"
EPISODES = "episodes"


class RunFolder:
    """An open run folder; a context manager that holds the folder's lock."""

    def __init__(self, path: Path, manifest: Manifest, configs: Mapping[str, str]) -> None:
        """Open a folder, making it or going on in it.

        Raises:
            RunFolderError: If it cannot be written, is in use, holds something else or a run of another config.
        """
        self.path = path
        try:
            path.mkdir(parents=True, exist_ok=True)
            self._lock = FolderLock(path)
        except OSError as error:
            raise unwritable(path, error) from error
        try:
            self.manifest = self._prepare(manifest, configs)
        except OSError as error:
            self._lock.close()
            raise unwritable(path, error) from error
        except BaseException:
            self._lock.close()
            raise

    def _prepare(self, asked: Manifest, configs: Mapping[str, str]) -> Manifest:
        there = read_manifest(self.path)
        if there is None:
            self._refuse_foreign()
        manifest = asked if there is None else continued(self.path, there, asked)
        self.clean()
        if manifest == there:
            return manifest
        texts = [configs[name] for name in asked.rows]
        (self.path / CONFIGS).mkdir(exist_ok=True)
        for name, text in zip(manifest.rows, texts, strict=True):
            write_text(self.path / CONFIGS / f"{name}.yaml", text)
        write_text(self.path / CONFIG, texts[0])
        # Last, for it says that the folder is a run's: a kill before this leaves nothing to misread.
        write_text(self.path / MANIFEST, manifest_text(manifest))
        return manifest

    def _refuse_foreign(self) -> None:
        """Never write among files that no run of ours has made."""
        ours = {".lock", CONFIG, CONFIGS}
        for item in sorted(self.path.iterdir()):
            if item.name not in ours and not item.name.startswith(PARTIAL):
                raise RunFolderError(
                    f"{self.path} is not empty and has no {MANIFEST}, so it is no run folder (it holds {item.name}); "
                    "choose another run=<name> or output=<folder>"
                )

    def clean(self) -> None:
        """Remove what a killed run left unfinished."""
        sweep(self.path)
        sweep(self.path / CONFIGS)
        for cell in self.path.glob(f"{EPISODES}/*"):
            sweep(cell)

    def episode(self, cell: str, seed: int) -> Path:
        """Give the folder of one episode."""
        return self.path / EPISODES / cell / str(seed)

    def record(self, cell: CellEntry, seed: int) -> EpisodeRecord | None:
        """Read the record of one episode and check that it is the one that belongs there.

        Returns:
            The record, or None if the episode has not been driven.

        Raises:
            RunFolderError: If it is damaged; nothing is changed on disk.
        """
        folder = self.episode(cell.folder, seed)
        if not folder.exists():
            return None
        record = read_record(folder)
        expected = (cell.scenario, cell.method, cell.variant, cell.reasoner, seed)
        found = (record.scenario, record.method, record.variant, record.reasoner, record.seed)
        if found != expected:
            raise damaged(folder / RECORD, f"it is the record of {found}, not of {expected}")
        return record

    def further(self, seeds: Collection[int]) -> int:
        """Count the episodes that the folder holds beyond those that are asked for."""
        asked = {str(seed) for seed in seeds}
        count = 0
        for cell in self.manifest.cells:
            there = {item.name for item in self.path.glob(f"{EPISODES}/{cell.folder}/[0-9]*")}
            count += len(there - asked if cell.folder in self.manifest.rows else there)
        return count

    def close(self) -> None:
        """Let others write."""
        self._lock.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def unwritable(path: Path, error: OSError) -> RunFolderError:
    """The error for a folder that cannot be written."""
    return RunFolderError(
        f"cannot write the run folder {path}: {error.strerror or error}; choose another output=<folder>"
    )


def new_run_path(experiment: Path, now: datetime) -> Path:
    """Choose a folder for a run without a name: its local time, made at once so that no other run takes it.

    Returns:
        The folder, new and empty.

    Raises:
        RunFolderError: If it cannot be made.
    """
    stem = now.strftime("%Y-%m-%d_%H%M%S")
    number = 1
    while True:
        path = experiment / (stem if number == 1 else f"{stem}-{number}")
        try:
            path.mkdir(parents=True)
        except FileExistsError:
            if not experiment.is_dir():
                raise unwritable(path, FileExistsError(17, f"{experiment} is a file")) from None
            number += 1
        except OSError as error:
            raise unwritable(path, error) from error
        else:
            return path
