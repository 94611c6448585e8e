"""Several processes: same results, dead workers replaced, none left behind."""

import signal
import subprocess
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import pytest
from toy_drive import LABELS, BuildToy, run_batch

from codriving.datatypes.record import Ending
from codriving.errors import ConfigError
from codriving.experiment.episode import EpisodeResult
from codriving.experiment.launchers import Serial, available_cores, worker_count
from codriving.experiment.processes import Processes, run_parallel, uninterrupted
from codriving.experiment.worker import Job, Objects, Report, Unit

UNITS = [Unit("cell", seed) for seed in range(8)]


@dataclass(frozen=True)
class SaveText:
    """Keeps a result as one file."""

    folder: Path

    def __call__(self, unit: Unit, result: EpisodeResult) -> None:
        """Keep it."""
        (self.folder / str(unit.seed)).write_text(repr(result.record))


@dataclass(frozen=True)
class Misconfigured:
    """Builds nothing, for the config is wrong."""

    def __call__(self, cell: str) -> Objects:
        """Refuse."""
        raise ConfigError("scenario.cavs must be at most 12, got 99")


def job(folder: Path, build: object) -> Job:
    folder.mkdir(exist_ok=True)
    return Job({"cell": LABELS}, build, SaveText(folder))  # type: ignore[arg-type]


def by_seed(reports: Iterable[Report]) -> list[Report]:
    return sorted(reports, key=lambda report: report.unit.seed)


def test_three_processes_do_what_one_does(tmp_path: Path) -> None:
    serial = list(Serial().launch(UNITS, job(tmp_path / "1", BuildToy(raises=(3,)))))
    parallel = by_seed(run_parallel(UNITS, job(tmp_path / "3", BuildToy(raises=(3,))), 3, ["numpy"]))
    assert parallel == serial
    assert [report.ending for report in serial].count(Ending.ERROR) == 1
    for unit in UNITS:
        assert (tmp_path / "1" / str(unit.seed)).read_text() == (tmp_path / "3" / str(unit.seed)).read_text()


def test_a_killed_worker_is_tried_once_more_and_the_batch_goes_on(tmp_path: Path) -> None:
    build = BuildToy(dies=(2,), gate=tmp_path, waits_from=99)
    report = run_batch(UNITS, job(tmp_path / "out", build), Processes(), workers=2)
    assert report.done == len(UNITS)
    assert [failed.unit.seed for failed in report.failed] == [2]
    assert report.failed[0].message == "WorkerDied: the process that drove this episode was killed by signal 9"
    assert (tmp_path / "died-2").read_text() == "xx"


def test_a_mistake_of_the_users_arrives_as_it_was_raised(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"got 99"):
        run_batch(UNITS, job(tmp_path / "out", Misconfigured()), Processes(), workers=2)


def test_what_is_started_uninterrupted_is_not_reached_by_ctrl_c() -> None:
    asked = [sys.executable, "-c", "import signal as s; print(s.SIGINT in s.pthread_sigmask(s.SIG_BLOCK, []))"]
    with uninterrupted():
        assert subprocess.run(asked, capture_output=True, text=True, check=True).stdout == "True\n"
    assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, [])


def test_auto_takes_the_cores_that_there_are_and_no_more_than_units() -> None:
    assert worker_count("auto", 1000) == available_cores()
    assert worker_count("auto", 1) == 1
    assert worker_count(5, 3) == 3
    assert worker_count(5, 0) == 1
