"""Real processes stopped in the middle: what was finished stays, no process is left behind, the bytes are the same."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Self

import pytest
from test_batch import deterministic
from toy_plan import EPISODES, toy, toy_plan

from codriving.experiment.batch import drive
from codriving.experiment.stopping import StopSignal, stopped_by_signals

SCRIPT = Path(__file__).parents[1] / "toy_plan.py"
DEADLINE = 30.0

pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")


def wait_until(condition: Callable[[], bool], what: str) -> None:
    end = time.monotonic() + DEADLINE
    while not condition():
        assert time.monotonic() < end, f"waited in vain: {what}"
        time.sleep(0.005)


def runs(pid: int) -> bool:
    """Whether a process is there and not just waiting to be buried."""
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except FileNotFoundError:
        if Path("/proc/self/stat").exists():
            return False
        return subprocess.run(["ps", "-p", str(pid)], capture_output=True, check=False).returncode == 0
    return state not in "ZX"


def feels_ctrl_c(pid: int) -> bool:
    """Whether SIGINT would reach a process; only Linux tells."""
    status = Path(f"/proc/{pid}/status")
    if not status.exists():
        return False
    fields = dict(line.split(":", 1) for line in status.read_text().splitlines())
    shielded = int(fields["SigBlk"], 16) | int(fields["SigIgn"], 16)
    return not shielded >> (signal.SIGINT - 1) & 1


class Started:
    """A batch of which two workers wait in the middle of an episode, from seed 4 on."""

    def __init__(self, folder: Path, workers: int) -> None:
        self.gate = folder / "gate"
        self.gate.mkdir()
        os.mkfifo(self.gate / "fifo")
        command = [sys.executable, str(SCRIPT), str(folder / "out"), str(workers), str(self.gate)]
        top = Path(__file__).parents[2]
        self.process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=top, start_new_session=True,
            env={**os.environ, "PYTHONPATH": str(top)},
        )  # fmt: skip
        wait_until(lambda: len(list(self.gate.glob("waiting-*"))) == workers, "workers at the gate")
        # What a worker leaves that is stopped while it writes.
        (folder / "out" / "run" / "mine" / "episodes" / "toy-steady-full" / ".partial-4-abc").mkdir()
        self.workers = [int(path.name.partition("-")[2]) for path in self.gate.glob("waiting-*")]

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        # A test that fails must not leave a batch behind.
        self.process.kill()
        self.process.communicate()
        for pid in filter(runs, self.workers):
            os.kill(pid, signal.SIGKILL)

    def end(self, send: Callable[[], None]) -> tuple[str, str]:
        """Stop the batch and wait for all of it to be gone."""
        send()
        out, err = self.process.communicate(timeout=DEADLINE)
        wait_until(lambda: not any(runs(pid) for pid in self.workers), "workers to go")
        return out, err


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    return deterministic(drive(toy_plan(tmp_path_factory.mktemp("reference")), build=toy()).folder)


def test_sigkill_loses_only_what_was_in_flight(tmp_path: Path, reference: dict[str, bytes]) -> None:
    with Started(tmp_path, 2) as batch:
        batch.end(batch.process.kill)
    assert batch.process.returncode == -signal.SIGKILL
    finished = {path.parent.name for path in (tmp_path / "out").glob("run/mine/episodes/*/*/record.json")}
    assert finished == {"0", "1", "2", "3"}
    resumed = drive(toy_plan(tmp_path / "out", workers=2), build=toy())
    assert (resumed.kept, resumed.driven) == (4, EPISODES - 4)
    assert deterministic(resumed.folder) == reference
    assert not list((tmp_path / "out").rglob(".partial-*"))


@pytest.mark.parametrize(
    ("number", "workers", "code"),
    [
        (signal.SIGINT, 1, 130),
        (signal.SIGINT, 2, 130),
        (signal.SIGTERM, 1, 143),
        (signal.SIGTERM, 2, 143),
        (signal.SIGHUP, 2, 129),
    ],
)
def test_a_signal_keeps_what_is_finished_and_says_how_to_go_on(
    tmp_path: Path, reference: dict[str, bytes], number: signal.Signals, workers: int, code: int
) -> None:
    with Started(tmp_path, workers) as batch:
        if workers > 1:
            assert not any(feels_ctrl_c(pid) for pid in batch.workers)
        # A terminal sends it to the whole group, workers included, and so does a service manager.
        out, err = batch.end(lambda: os.killpg(batch.process.pid, number))
    assert batch.process.returncode == code
    assert out == ""
    assert f"Stopped; 4 of {EPISODES} episodes are finished and kept." in err
    assert err.splitlines()[-1] == "Go on with: codriving run scenario=toy run=mine"
    assert "Traceback" not in err
    assert not list((tmp_path / "out").rglob(".partial-*"))
    resumed = drive(toy_plan(tmp_path / "out"), build=toy())
    assert resumed.kept == 4
    assert deterministic(resumed.folder) == reference


def test_a_single_process_may_be_asked_to_stop_and_its_workers_go_with_it(tmp_path: Path) -> None:
    with Started(tmp_path, 2) as batch:
        _, err = batch.end(batch.process.terminate)
    assert batch.process.returncode == 143
    assert err.splitlines()[-1] == "Go on with: codriving run scenario=toy run=mine"


def test_signals_are_as_before_after_a_batch_and_what_is_ignored_stays_ignored() -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with stopped_by_signals():
            # nohup ignores it, and so does all that is started by it.
            assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
            with pytest.raises(StopSignal, match="SIGTERM"):
                signal.raise_signal(signal.SIGTERM)
            # What follows is not broken off by a second one.
            signal.raise_signal(signal.SIGTERM)
        assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL
    finally:
        signal.signal(signal.SIGHUP, before)
