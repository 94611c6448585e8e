"""Runs in which a model reasons: side by side, stopped by its limits, refused before the first episode."""

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Generator, Iterator, Sequence
from functools import partial
from io import StringIO
from pathlib import Path
from select import select

import pytest
import toy_models
from test_batch import all_files, deterministic
from toy_models import CLIENTS, EPISODES, BuildAsking, ToyClient, asking_cell, asking_plan

from codriving.commands import run
from codriving.datatypes.record import Ending
from codriving.errors import ModelError, ModelUnavailableError, SpendingLimitError
from codriving.experiment.batch import HaltedError, drive
from codriving.experiment.launchers import Serial
from codriving.experiment.objects import model_of
from codriving.experiment.places import side_by_side
from codriving.experiment.processes import Processes
from codriving.experiment.progress import show_progress
from codriving.experiment.worker import Job, Report, Unit
from codriving.runs.episode_folder import read_record

TOP = Path(__file__).parents[2]


@pytest.fixture(autouse=True)
def clients() -> Iterator[dict[str, ToyClient]]:
    """No test finds the clients of another."""
    CLIENTS.clear()
    CLIENTS["gpt"] = ToyClient()
    yield CLIENTS
    CLIENTS.clear()


def unavailable(*seeds: int) -> Callable[[int, int], None]:
    def fail(seed: int, step: int) -> None:
        if seed in seeds and step == 1:
            raise ModelUnavailableError("gpt: the server said 503, asked 3 times")

    return fail


def recorded(folder: Path) -> dict[int, Ending]:
    paths = folder.glob("episodes/*/*/record.json")
    return {int(path.parent.name): read_record(path.parent).outcome.ending for path in paths}


def settled() -> None:
    """Wait until no thread of a batch is left."""
    for thread in threading.enumerate():
        if thread.name.startswith("codriving-episode"):
            thread.join(20)


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """The bytes of episodes one after another."""
    folder = drive(asking_plan(tmp_path_factory.mktemp("reference"), launcher=Serial()), build=BuildAsking).folder
    return deterministic(folder)


@pytest.mark.parametrize(("workers", "concurrency"), [("auto", 1), ("auto", 4), (2, 8), (8, 2)])
def test_the_bytes_do_not_depend_on_how_many_are_side_by_side(
    tmp_path: Path, reference: dict[str, bytes], workers: int | str, concurrency: int
) -> None:
    at_once = min(concurrency, 8 if workers == "auto" else int(workers))
    barrier = threading.Barrier(at_once)

    def meet(seed: int, step: int) -> None:
        # No episode passes the first step of the first episodes unless all of them are under way.
        if step == 0 and seed < at_once:
            barrier.wait(20)

    client = CLIENTS["gpt"] = ToyClient(meet)
    plan = asking_plan(tmp_path, asking_cell(max_concurrency=concurrency), workers=workers)
    assert deterministic(drive(plan, build=BuildAsking).folder) == reference
    assert client.most == at_once == side_by_side(workers, concurrency)


def test_who_asks_no_model_is_driven_in_processes(tmp_path: Path) -> None:
    launched: list[str] = []

    class Watched(Processes):
        def launch(
            self, units: Sequence[Unit], job: Job, workers: int | str, preload: Sequence[str]
        ) -> Generator[Report, None, None]:
            launched.extend(unit.cell for unit in units)
            yield from super().launch(units, job, 1, preload)

    finished = drive(
        asking_plan(tmp_path, asking_cell(), asking_cell(asks=False), launcher=Watched()), build=BuildAsking
    )
    assert launched == ["toy-computing-full"] * EPISODES
    assert (finished.driven, finished.failed) == (2 * EPISODES, ())
    assert len(CLIENTS["gpt"].asked) > EPISODES
    assert [row["reasoner"] for row in finished.tables.summary.rows] == ["gpt", "rules"]


def test_a_model_is_found_only_where_the_method_asks_it() -> None:
    assert model_of(asking_cell().resolved) is not None
    assert model_of(asking_cell(asks=False).resolved) is None


def test_an_episode_without_an_answer_is_an_error_and_only_it_is_repeated(
    tmp_path: Path, reference: dict[str, bytes]
) -> None:
    CLIENTS["gpt"].does = unavailable(2, 7)
    broken = drive(asking_plan(tmp_path), build=BuildAsking)
    assert [report.unit.seed for report in broken.failed] == [2, 7]
    text = (broken.folder / "episodes/toy-asking-full/2/error.txt").read_text()
    assert text == "ModelUnavailableError: gpt: the server said 503, asked 3 times\n"
    CLIENTS["gpt"] = client = ToyClient()
    mended = drive(asking_plan(tmp_path), build=BuildAsking)
    assert (mended.driven, {seed for seed, _ in client.asked}) == (2, {2, 7})
    assert deterministic(mended.folder) == reference


def test_failures_in_a_row_stop_the_batch_and_it_goes_on(tmp_path: Path, reference: dict[str, bytes]) -> None:
    halted, fail = threading.Event(), unavailable(4, 5, 6, 7, 8, 9)

    def wait_and_fail(seed: int, step: int) -> None:
        # The thread that drives may be far ahead of the one that counts.
        if seed == 7:
            halted.wait(20)
        fail(seed, step)

    CLIENTS["gpt"].does = wait_and_fail
    said = (
        r"^gpt failed 3 episodes in a row \(llm.failures_in_a_row\), the last with: gpt: the server said 503, asked 3 "
        rf"times; 4 of {EPISODES} episodes are finished and kept in "
    )
    with pytest.raises(HaltedError, match=said):
        drive(asking_plan(tmp_path, asking_cell(max_concurrency=1)), build=BuildAsking)
    halted.set()
    settled()
    endings = recorded(tmp_path / "run" / "mine")
    assert {seed for seed, ending in endings.items() if ending is not Ending.ERROR} == {0, 1, 2, 3}
    assert {seed for seed, ending in endings.items() if ending is Ending.ERROR} == {4, 5, 6}
    CLIENTS["gpt"] = ToyClient()
    assert deterministic(drive(asking_plan(tmp_path), build=BuildAsking).folder) == reference


def test_an_answer_between_two_failures_is_no_row(tmp_path: Path) -> None:
    CLIENTS["gpt"].does = unavailable(0, 1, 3, 4, 6, 8, 9)
    finished = drive(asking_plan(tmp_path, asking_cell(max_concurrency=1)), build=BuildAsking)
    assert len(finished.failed) == 7


def test_failures_of_another_kind_do_not_stop_the_batch(tmp_path: Path) -> None:
    def fail(seed: int, step: int) -> None:
        raise RuntimeError("a bug")

    CLIENTS["gpt"].does = fail
    assert len(drive(asking_plan(tmp_path), build=BuildAsking).failed) == EPISODES


def test_each_model_of_a_sweep_is_counted_by_itself(tmp_path: Path) -> None:
    CLIENTS["dead"] = ToyClient(unavailable(*range(EPISODES)))
    cells = asking_cell("gpt", failures_in_a_row=3), asking_cell("dead", failures_in_a_row=1000)
    finished = drive(asking_plan(tmp_path, *cells), build=BuildAsking)
    assert len(finished.failed) == EPISODES
    assert {report.unit.cell for report in finished.failed} == {"toy-asking-full-dead"}


@pytest.mark.parametrize("concurrency", [1, 3])
def test_a_limit_keeps_what_is_finished_and_records_nothing_else(
    tmp_path: Path, reference: dict[str, bytes], concurrency: int
) -> None:
    def limit(seed: int, step: int) -> None:
        if seed >= 4:
            raise SpendingLimitError("llm.max_cost=1 USD is used up (1.02 USD)")

    CLIENTS["gpt"].does = limit
    with pytest.raises(HaltedError, match=r"^llm.max_cost=1 USD is used up \(1.02 USD\); \d of 10 episodes are finish"):
        drive(asking_plan(tmp_path, asking_cell(max_concurrency=concurrency)), build=BuildAsking)
    settled()
    endings = recorded(tmp_path / "run" / "mine")
    assert set(endings) <= {0, 1, 2, 3}
    assert Ending.ERROR not in endings.values()
    if concurrency == 1:
        assert set(endings) == {0, 1, 2, 3}
    assert not list(tmp_path.rglob(".partial-*"))
    # The limit is raised, and the same run goes on.
    CLIENTS["gpt"] = ToyClient()
    again = drive(asking_plan(tmp_path, asking_cell(max_cost=2.0, max_concurrency=2, cache="use")), build=BuildAsking)
    assert again.kept == len(endings)
    assert deterministic(again.folder) == reference


def test_the_line_on_a_limit_says_how_to_go_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def limit(seed: int, step: int) -> None:
        if seed == 4:
            raise SpendingLimitError("llm.max_cost=1 USD is used up (1.02 USD).")

    CLIENTS["gpt"].does = limit
    monkeypatch.setattr(
        run, "make_plan", lambda points, config_dir: asking_plan(tmp_path, asking_cell(max_concurrency=1))
    )
    monkeypatch.setattr("codriving.experiment.batch.BuildObjects", BuildAsking)
    with pytest.raises(ModelError) as stopped:
        run.run_experiment(["seed=0", "llm=offline"])
    assert str(stopped.value) == (
        "llm.max_cost=1 USD is used up (1.02 USD); 4 of 10 episodes are finished and kept; "
        "go on with: codriving run seed=0 llm=offline run=mine"
    )


@pytest.mark.parametrize("name", ["mine", None])
def test_a_model_that_cannot_be_reached_is_refused_before_anything_is_made(tmp_path: Path, name: str | None) -> None:
    CLIENTS["gpt"].refuses = ModelError("OPENAI_API_KEY is not set; set it to your key")
    with pytest.raises(ModelError, match=r"^OPENAI_API_KEY is not set; set it to your key$"):
        drive(asking_plan(tmp_path, name=name), build=BuildAsking)
    assert list(tmp_path.iterdir()) == []
    assert CLIENTS["gpt"].asked == []


def test_a_run_that_is_there_is_left_as_it_is(tmp_path: Path) -> None:
    folder = drive(asking_plan(tmp_path, episodes=4), build=BuildAsking).folder
    before = all_files(folder)
    CLIENTS["gpt"] = ToyClient(refuses=ModelError("no server"))
    assert drive(asking_plan(tmp_path, episodes=4), build=BuildAsking).kept == 4
    assert CLIENTS["gpt"].preflights == 0
    with pytest.raises(ModelError, match=r"^no server$"):
        drive(asking_plan(tmp_path), build=BuildAsking)
    after = all_files(folder)
    assert {name for name in after if after[name] != before.get(name)} <= {"manifest.json", "config.yaml"}
    CLIENTS["gpt"] = ToyClient()
    assert drive(asking_plan(tmp_path), build=BuildAsking).kept == 4


def test_each_model_is_tried_once_and_none_that_is_replayed(tmp_path: Path) -> None:
    CLIENTS["replayed"] = ToyClient(refuses=ModelError("no server"))
    cells = asking_cell("gpt"), asking_cell("gpt", failures_in_a_row=9), asking_cell("replayed", cache="replay")
    drive(asking_plan(tmp_path, *cells, episodes=1), build=BuildAsking)
    assert (CLIENTS["gpt"].preflights, CLIENTS["replayed"].preflights) == (1, 0)


def test_progress_tells_what_was_used_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stream = StringIO()
    monkeypatch.setattr("codriving.experiment.batch.show_progress", partial(show_progress, stream=stream))

    def retried(seed: int, step: int) -> None:
        if (seed, step) == (0, 0):
            CLIENTS["gpt"].on_retry("503")

    CLIENTS["gpt"].does = retried
    drive(asking_plan(tmp_path, asking_cell(max_concurrency=1)), build=BuildAsking)
    used = CLIENTS["gpt"].used
    assert stream.getvalue().splitlines()[-1] == (
        f"{EPISODES} of {EPISODES} episodes done, 0 failed; {used.tokens:,} tokens, {used.cost:.4f} USD, 1 retries"
    )
    stream.truncate(0)
    drive(asking_plan(tmp_path / "rules", asking_cell(asks=False), workers=1), build=BuildAsking)
    assert stream.getvalue().splitlines()[-1].endswith("episodes done, 0 failed")


def test_how_a_model_is_asked_makes_no_other_cell_and_which_one_does() -> None:
    cell = asking_cell()
    same = asking_cell(max_concurrency=9, failures_in_a_row=9, cache="replay", max_cost=7.0)
    assert same.fingerprint == cell.fingerprint
    assert same.entry().settings == cell.entry().settings
    assert asking_cell("other").fingerprint != cell.fingerprint


@pytest.mark.skipif(os.name == "nt", reason="needs process groups")
def test_ctrl_c_stops_at_once_while_servers_are_waited_for(tmp_path: Path, reference: dict[str, bytes]) -> None:
    hears, says = os.pipe()
    holds, never = os.pipe()
    process = subprocess.Popen(
        [sys.executable, toy_models.__file__, str(tmp_path / "out"), str(says), str(holds)],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=TOP, start_new_session=True,
        env={**os.environ, "PYTHONPATH": str(TOP)}, pass_fds=(says, holds),
    )  # fmt: skip
    os.close(says)
    os.close(holds)
    try:
        # Three threads drive: once all of them wait, the four episodes before are finished.
        for _ in range(3):
            assert select([hears], [], [], 60)[0], "waited in vain for three episodes that wait at the same time"
            assert os.read(hears, 1) == b"w", "the batch ended before three episodes waited at the same time"
        os.killpg(process.pid, signal.SIGINT)
        out, err = process.communicate(timeout=60)
    finally:
        process.kill()
        process.communicate()
        os.close(hears)
        os.close(never)
    assert process.returncode == 130
    assert out == ""
    assert f"Stopped; 4 of {EPISODES} episodes are finished and kept." in err
    assert err.splitlines()[-1] == "Go on with: codriving run scenario=toy run=mine"
    assert "Traceback" not in err
    resumed = drive(asking_plan(tmp_path / "out"), build=BuildAsking)
    assert resumed.kept == 4
    assert deterministic(resumed.folder) == reference
