"""The folder of one run: opened under a lock, checked against the config, resumed where it was left."""

import errno
from collections.abc import Collection, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from datetime import datetime
from pathlib import Path
from typing import Self

from filelock import FileLock, Timeout

from codriving.datatypes import Ending, EpisodeRecord
from codriving.errors import DamagedEpisodeError, RunFolderError
from codriving.runs.atomic import PARTIAL, sweep, write_text
from codriving.runs.continuation import continued, measured, other_behaviour
from codriving.runs.episode_folder import EPISODES, episode_folder, read_record
from codriving.runs.identity import BEHAVIOUR, CellEntry
from codriving.runs.intact import RECORD, check_files
from codriving.runs.json_files import damaged, encode
from codriving.runs.manifest import MANIFEST, Manifest, read_manifest
from codriving.runs.parts import PARTS

CONFIG = "config.yaml"
CONFIGS = "configs"


@contextmanager
def locked(folder: Path, waits: bool = False) -> Iterator[None]:
    """Keep other processes from writing a folder, with a file ``.lock`` in it; the system frees it when we die.

    Args:
        waits: Whether to wait for another process that holds it.

    Raises:
        RunFolderError: If another process holds it.
        OSError: If the folder cannot be written.
    """
    # The lock is emptied when it is taken, and so would be what a link in its place leads to.
    within(folder, folder / ".lock")
    lock = FileLock(folder / ".lock", timeout=-1 if waits else 0, mode=0o666)
    try:
        lock.acquire()
    except Timeout:
        raise RunFolderError(
            f"{folder} is being written by another run; wait for it or choose another run=<name>"
        ) from None
    except NotImplementedError:
        # Some network file systems know no locks; working without one beats not working.
        pass
    try:
        yield
    finally:
        lock.release()


class RunFolder:
    """An open run folder; a context manager that holds the folder's lock."""

    def __init__(
        self,
        path: Path,
        manifest: Manifest,
        configs: Mapping[str, str],
        waits: bool = False,
        joins: bool = False,
    ) -> None:
        """Open a folder, making it or going on in it.

        Args:
            waits: Whether to wait for another process that writes it.
            joins: Whether the parts in it are joined.
        """
        self.path, self._joins = path, joins
        with ExitStack() as opening:
            try:
                path.mkdir(parents=True, exist_ok=True)
                opening.enter_context(locked(path, waits))
                self.manifest = self._prepare(manifest, configs)
            except OSError as error:
                raise unwritable(path, error) from error
            self._lock = opening.pop_all()

    def _prepare(self, asked: Manifest, configs: Mapping[str, str]) -> Manifest:
        if (there := read_manifest(self.path)) is None:
            self._refuse_foreign()
        manifest = asked if there is None else continued(self.path, there, asked)
        if there is not None and there.behaviour != BEHAVIOUR and not self._complete(manifest):
            raise other_behaviour(self.path, there)
        for name, cell in zip(manifest.rows, asked.cells, strict=True):
            # Where times are measured a further episode is like none that is there.
            held = [old for old in there.cells if old.folder == name] if there is not None else []
            times = [one.repeatable for one in (*held, cell)]
            if held and False in times and not self._complete(replace(manifest, rows=(name,))):
                raise measured(self.path, name)
        for place in (*self.path.iterdir(), *self.path.glob(f"{EPISODES}/*")):
            within(self.path, place)
        self.clean()
        if manifest == there:
            return manifest
        # What release 0.1 has finished stays to the byte; what it has begun is told by choices and files from now on.
        if there is not None and replace(manifest, cells=there.cells) == there and self._complete(manifest):
            return manifest
        (self.path / CONFIGS).mkdir(exist_ok=True)
        for name, asked_as in zip(manifest.rows, asked.rows, strict=True):
            write_text(self.path / CONFIGS / f"{name}.yaml", configs[asked_as])
        write_text(self.path / CONFIG, configs[asked.rows[0]])
        # Last, for it says that the folder is a run's: a kill before this leaves nothing to misread.
        write_text(self.path / MANIFEST, encode(manifest))
        return manifest

    def _refuse_foreign(self) -> None:
        """Never write among files that no run of ours has made."""
        ours = {".lock", CONFIG, CONFIGS}
        for item in sorted(self.path.iterdir()):
            if item.name == PARTS and self._joins:
                continue
            if item.name == PARTS:
                raise RunFolderError(
                    f"{self.path} holds parts of a run that have not been joined: codriving join {self.path}, or "
                    "choose another run=<name>"
                )
            if item.name not in ours and not item.name.startswith(PARTIAL):
                raise RunFolderError(
                    f"{self.path} is not empty and has no {MANIFEST}, so it is no run folder (it holds {item.name}); "
                    "choose another run=<name> or output=<folder>"
                )

    def _complete(self, manifest: Manifest) -> bool:
        """Tell whether each episode that is asked for is there and did not end in an error."""
        cells = {cell.folder: cell for cell in manifest.cells}
        seeds = range(manifest.first_seed, manifest.first_seed + manifest.episodes)
        records = (self.record(cells[name], seed) for name in manifest.rows for seed in seeds)
        try:
            return all(record is not None and record.outcome.ending is not Ending.ERROR for record in records)
        except DamagedEpisodeError:
            return False

    def clean(self) -> None:
        """Remove what a killed run left unfinished."""
        sweep(self.path)
        sweep(self.path / CONFIGS)
        for cell in self.path.glob(f"{EPISODES}/*"):
            sweep(cell)

    def episode(self, cell: str, seed: int) -> Path:
        """Give the folder of one episode."""
        return episode_folder(self.path, cell, seed)

    def record(self, cell: CellEntry, seed: int) -> EpisodeRecord | None:
        """Read the record of one episode, as ``checked_record`` does."""
        return checked_record(self.path, cell, seed)

    def left_out(self, seeds: Collection[int]) -> int:
        """Count the episodes that the folder holds beyond those that are asked for."""
        asked = {str(seed) for seed in seeds}
        count = 0
        for cell in self.manifest.cells:
            there = {item.name for item in self.path.glob(f"{EPISODES}/{cell.folder}/[0-9]*")}
            count += len(there - asked if cell.folder in self.manifest.rows else there)
        return count

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._lock.close()


def checked_record(run: Path, cell: CellEntry, seed: int) -> EpisodeRecord | None:
    """Read the record of one episode of a run and check that it is the one that belongs there.

    Returns:
        The record, or None if the episode has not been driven.

    Raises:
        DamagedEpisodeError: If it, or another file of the episode, is damaged; nothing is changed on disk.
    """
    folder = episode_folder(run, cell.folder, seed)
    if not folder.exists():
        return None
    within(run, folder)
    record = read_record(folder)
    check_files(folder, record)
    expected = (*cell.labels, seed)
    found = (record.scenario, record.method, record.variant, record.reasoner, record.seed)
    if found != expected:
        raise damaged(folder / RECORD, f"it is the record of {found}, not of {expected}")
    return record


def within(run: Path, path: Path) -> Path:
    """Give back a path of a run folder, unless a symbolic link in it leads elsewhere.

    Raises:
        RunFolderError: If what is written there would end up outside the run folder.
    """
    if not path.resolve().is_relative_to(run.resolve()):
        raise RunFolderError(
            f"{path} is a symbolic link out of the run folder {run}, in which nothing is read or written through one; "
            "put a copy in its place"
        )
    return path


def removed(path: Path, what: str = "") -> RunFolderError:
    """The error for a folder that vanished while it was written."""
    return RunFolderError(
        f"the run folder {path} was removed or moved while it was written{f' ({what})' if what else ''}; put it back "
        "if you can, and run again with the same run=<name>: what is there is kept"
    )


def unwritable(path: Path, error: OSError) -> RunFolderError:
    """The error for a folder that cannot be written."""
    cure = "a shorter run=<name> or" if error.errno == errno.ENAMETOOLONG else "another"
    return RunFolderError(
        f"cannot write the run folder {path}: {error.strerror or error}; choose {cure} output=<folder>"
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
