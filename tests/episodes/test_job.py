"""One unit: objects built once, failures kept, the user's mistakes handed up."""

from collections.abc import Callable

import pytest
from toy_drive import LABELS, BuildToy

from codriving.datatypes.outcome import Ending
from codriving.episodes.episode import EpisodeResult
from codriving.episodes.job import Job, Worker
from codriving.episodes.unit import Objects, Unit
from codriving.errors import ConfigError, RunFolderError


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
        if result.record.score is not None:
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
