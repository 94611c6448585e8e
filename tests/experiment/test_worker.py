"""One unit: objects built once, failures kept, the user's mistakes handed up."""

from collections.abc import Callable
from dataclasses import replace

import pytest
from toy_drive import LABELS, BuildToy

from codriving.datatypes.record import Ending
from codriving.errors import ConfigError, RunFolderError
from codriving.experiment.episode import EpisodeResult
from codriving.experiment.worker import CELLS_AT_ONCE, AfterEpisode, Job, Objects, Report, Unit, Worker


def job(build: Callable[[str], Objects], saved: list[tuple[int, EpisodeResult]]) -> Job:
    return Job({"cell": LABELS}, build, lambda unit, result: saved.append((unit.seed, result)))


def test_objects_are_built_once_a_cell() -> None:
    built: list[str] = []
    saved: list[tuple[int, EpisodeResult]] = []

    def build(cell: str) -> Objects:
        built.append(cell)
        return BuildToy()(cell)

    worker = Worker(job(build, saved))
    reports = [worker.run(Unit("cell", seed)) for seed in range(3)]
    assert built == ["cell"]
    assert [seed for seed, _ in saved] == [0, 1, 2]
    assert all(report.ending is Ending.SUCCESS for report in reports)


def test_only_the_objects_of_the_last_cells_are_kept() -> None:
    built: list[str] = []
    names = [f"cell {index}" for index in range(CELLS_AT_ONCE + 1)]

    def build(cell: str) -> Objects:
        built.append(cell)
        return BuildToy()(cell)

    worker = Worker(Job(dict.fromkeys(names, LABELS), build, lambda unit, result: None))
    for name in [*names, names[-1], names[1], names[0]]:
        worker.run(Unit(name, 0))
    assert built == [*names, names[0]]


def test_a_failing_constructor_is_the_failure_of_each_episode() -> None:
    def build(cell: str) -> Objects:
        raise RuntimeError("no such thing")

    saved: list[tuple[int, EpisodeResult]] = []
    report = Worker(job(build, saved)).run(Unit("cell", 4))
    assert (report.ending, report.message) == (Ending.ERROR, "RuntimeError: no such thing")
    assert "in build" in saved[0][1].traceback


def test_a_mistake_of_the_users_stops_the_batch() -> None:
    def build(cell: str) -> Objects:
        raise ConfigError("wrong")

    with pytest.raises(ConfigError):
        Worker(job(build, [])).run(Unit("cell", 4))


def test_a_result_that_cannot_be_written_is_a_failed_episode() -> None:
    saved: list[EpisodeResult] = []

    def save(unit: Unit, result: EpisodeResult) -> None:
        if result.record.scores:
            raise ValueError("NaN is not a number")
        saved.append(result)

    report = Worker(Job({"cell": LABELS}, BuildToy(), save)).run(Unit("cell", 1))
    assert report.message == "ValueError: NaN is not a number"
    assert saved[0].record.outcome.ending is Ending.ERROR


def test_a_full_disk_stops_the_batch() -> None:
    def save(unit: Unit, result: EpisodeResult) -> None:
        raise RunFolderError("no space left")

    with pytest.raises(RunFolderError):
        Worker(Job({"cell": LABELS}, BuildToy(), save)).run(Unit("cell", 1))


class Notes(AfterEpisode):
    """Remembers what was finished; says which seeds are kept already."""

    def __init__(self, *kept: int) -> None:
        self._kept = kept
        self.finished: list[int] = []
        self.abandoned: list[tuple[int, str]] = []

    def saved(self, unit: Unit) -> Ending | None:
        """Those given."""
        return Ending.TIMEOUT if unit.seed in self._kept else None

    def finish(self, unit: Unit) -> None:
        """Remember it."""
        self.finished.append(unit.seed)

    def abandon(self, unit: Unit, error: Exception) -> None:
        """Remember why."""
        self.abandoned.append((unit.seed, str(error)))


def test_what_comes_after_comes_after_the_result_is_saved() -> None:
    saved: list[tuple[int, EpisodeResult]] = []
    notes = Notes()
    worker = Worker(replace(job(BuildToy(), saved), after=notes))
    assert worker.run(Unit("cell", 3)).ending is Ending.SUCCESS
    assert ([seed for seed, _ in saved], notes.finished) == ([3], [3])


def test_an_episode_that_is_kept_is_not_driven_again() -> None:
    saved: list[tuple[int, EpisodeResult]] = []
    notes = Notes(3)
    worker = Worker(replace(job(BuildToy(), saved), after=notes))
    assert worker.run(Unit("cell", 3)) == Report(Unit("cell", 3), Ending.TIMEOUT)
    assert (saved, notes.finished) == ([], [3])


def test_a_process_that_dies_of_what_comes_after_spoils_no_record() -> None:
    saved: list[tuple[int, EpisodeResult]] = []
    notes = Notes(3)
    worker = Worker(replace(job(BuildToy(), saved), after=notes))
    assert worker.abandon(Unit("cell", 3), RuntimeError("killed")).ending is Ending.TIMEOUT
    assert worker.abandon(Unit("cell", 4), RuntimeError("killed")).ending is Ending.ERROR
    assert ([seed for seed, _ in saved], notes.abandoned) == ([4], [(3, "killed")])
