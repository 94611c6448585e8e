"""Several threads: same results as one after another, objects of their own, and nothing saved once the batch stops."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from threading import Barrier, Event, Lock, current_thread, get_ident
from threading import enumerate as all_threads

import pytest
from toy_drive import LABELS, BuildToy, ToyDeliberation, ToyEnvironment, ToyMethod, ToyMetrics, run_batch

from codriving.datatypes.record import Ending
from codriving.datatypes.world import WorldState
from codriving.errors import ConfigError, ModelError, ModelUnavailableError, SpendingLimitError
from codriving.experiment.episode import EpisodeResult, run_episode
from codriving.experiment.launchers import Serial
from codriving.experiment.threads import Threads
from codriving.experiment.worker import AfterEpisode, Job, Objects, Unit
from codriving.metrics.scorer import Scorer

UNITS = [Unit("cell", seed) for seed in range(9)]
PATIENCE = 20.0
"""How long a test waits before it fails [s]; none waits as long if it passes."""


@dataclass
class Kept:
    """Keeps records in memory."""

    records: dict[int, str] = field(default_factory=dict)

    def __call__(self, unit: Unit, result: EpisodeResult) -> None:
        """Keep one."""
        self.records[unit.seed] = repr(result.record)


@dataclass
class Acting(ToyMethod):
    """Does something of the test's before each decision."""

    does: Callable[["Acting", WorldState], None] = lambda method, world: None

    def act(self, world: WorldState) -> ToyDeliberation:
        """Do it, then go on."""
        self.does(self, world)
        return super().act(world)


def job(
    does: Callable[[Acting, WorldState], None], kept: Kept, made: list[Acting] | None = None, after: object = None
) -> Job:
    def build(cell: str) -> Objects:
        method = Acting(does=does)
        if made is not None:
            made.append(method)
        return Objects(ToyEnvironment(), method, {"toy": Scorer(ToyMetrics(), {})})

    return Job({"cell": LABELS}, build, kept, after)  # type: ignore[arg-type]


def episode_threads() -> list[str]:
    return [thread.name for thread in all_threads() if thread.name.startswith("codriving-episode")]


def test_any_number_of_threads_does_what_one_after_another_does() -> None:
    serial = Kept()
    expected = list(Serial().launch(UNITS, Job({"cell": LABELS}, BuildToy(raises=(3,)), serial)))
    assert [report.ending for report in expected].count(Ending.ERROR) == 1
    for threads in (1, 3, 20):
        kept = Kept()
        reports = list(Threads().launch(UNITS, Job({"cell": LABELS}, BuildToy(raises=(3,)), kept), threads, ()))
        assert sorted(reports, key=lambda report: report.unit.seed) == expected
        assert kept.records == serial.records
    assert not episode_threads()


def test_episodes_are_driven_side_by_side_with_objects_of_their_own() -> None:
    barrier, made, inside = Barrier(3), list[Acting](), dict[int, int]()

    def meet(method: Acting, world: WorldState) -> None:
        # No thread passes unless three are here at the same time.
        if world.step == 0:
            barrier.wait(PATIENCE)
        assert inside.setdefault(id(method), get_ident()) == get_ident()

    reports = list(Threads().launch(UNITS, job(meet, Kept(), made), 3, ()))
    assert not [report for report in reports if report.ending is Ending.ERROR]
    assert len(made) == len(set(inside.values())) == 3


def test_no_more_at_once_than_asked_for() -> None:
    lock, now, most = Lock(), set[int](), list[int]()

    def count(method: Acting, world: WorldState) -> None:
        with lock:
            now.add(id(method))
            most.append(len(now))
        with lock:
            now.discard(id(method))

    list(Threads().launch(UNITS, job(count, Kept()), 2, ()))
    assert max(most) <= 2
    assert Threads().prepare("auto", 3, ()) is None


def test_a_failed_answer_ends_the_episode_and_the_batch_goes_on() -> None:
    def fail(method: Acting, world: WorldState) -> None:
        if method.seed == 2 and world.step == 1:
            raise ModelUnavailableError("the server said 503, asked 3 times")

    kept = Kept()
    report = run_batch(UNITS, job(fail, kept), Threads(), workers=3)
    assert report.done == len(kept.records) == len(UNITS)
    assert [(failed.unit.seed, failed.message) for failed in report.failed] == [
        (2, "ModelUnavailableError: the server said 503, asked 3 times")
    ]


@pytest.mark.parametrize("error", [SpendingLimitError("llm.max_cost=1 USD is used up"), ModelError("no such model")])
def test_a_model_that_must_not_be_used_stops_the_batch_and_leaves_no_record(error: ModelError) -> None:
    waiting, release, kept = Event(), Event(), Kept()

    def limit(method: Acting, world: WorldState) -> None:
        if method.seed == 1:
            waiting.set()
            # As if it waited for its server's answer.
            release.wait(PATIENCE)
        if method.seed == 4:
            waiting.wait(PATIENCE)
            raise error

    with pytest.raises(type(error), match=str(error)):
        run_batch(UNITS, job(limit, kept), Threads(), workers=2)
    before = dict(kept.records)
    assert sorted(before) == [0, 2, 3]
    release.set()
    for thread in all_threads():
        if thread is not current_thread() and thread.name.startswith("codriving-episode"):
            thread.join(PATIENCE)
    assert kept.records == before
    assert not episode_threads()


def test_an_episode_alone_lets_such_an_error_pass() -> None:
    def limit(method: Acting, world: WorldState) -> None:
        raise SpendingLimitError("used up")

    with pytest.raises(SpendingLimitError):
        run_episode(ToyEnvironment(), Acting(does=limit), {"toy": Scorer(ToyMetrics(), {})}, 1, LABELS)


def test_of_a_servers_failure_no_more_is_kept_than_its_message() -> None:
    def fail(method: Acting, world: WorldState) -> None:
        try:
            raise RuntimeError("what the server said: sk-secret")
        except RuntimeError as cause:
            raise ModelUnavailableError("the server refuses") from cause

    result = run_episode(ToyEnvironment(), Acting(does=fail), {"toy": Scorer(ToyMetrics(), {})}, 1, LABELS)
    assert result.traceback == "ModelUnavailableError: the server refuses\n"


def test_closing_the_batch_abandons_what_is_in_flight() -> None:
    waiting, release, kept, steps = Event(), Event(), Kept(), list[int]()

    def wait(method: Acting, world: WorldState) -> None:
        if method.seed >= 2:
            steps.append(world.step)
            waiting.set()
            release.wait(PATIENCE)

    reports = Threads().launch(UNITS, job(wait, kept), 2, ())
    assert {next(reports).unit.seed, next(reports).unit.seed} == {0, 1}
    assert waiting.wait(PATIENCE)
    reports.close()
    release.set()
    for thread in all_threads():
        if thread.name.startswith("codriving-episode"):
            thread.join(PATIENCE)
    assert sorted(kept.records) == [0, 1]
    # No further question was paid for.
    assert set(steps) == {0}


def test_a_mistake_of_the_users_arrives_as_it_was_raised() -> None:
    def misconfigured(cell: str) -> Objects:
        raise ConfigError("scenario.cavs must be at most 12, got 99")

    with pytest.raises(ConfigError, match=r"got 99"):
        run_batch(UNITS, Job({"cell": LABELS}, misconfigured, Kept()), Threads(), workers=3)


def test_what_comes_after_saving_is_done_here_and_saved_episodes_are_not_driven() -> None:
    finished: list[tuple[int, int]] = []

    class Film(AfterEpisode):
        def saved(self, unit: Unit) -> Ending | None:
            return Ending.SUCCESS if unit.seed in (3, 5) else None

        def finish(self, unit: Unit) -> None:
            finished.append((unit.seed, get_ident()))

        def abandon(self, unit: Unit, error: Exception) -> None:
            raise AssertionError

    kept = Kept()
    reports = list(Threads().launch(UNITS, job(lambda method, world: None, kept, after=Film()), 3, ()))
    assert sorted(report.unit.seed for report in reports) == sorted(seed for seed, _ in finished) == list(range(9))
    assert {where for _, where in finished} == {get_ident()}
    assert sorted(kept.records) == [0, 1, 2, 4, 6, 7, 8]


def test_the_cpu_time_of_a_decision_leaves_out_other_threads() -> None:
    asked, burnt = Event(), Event()

    def use(method: Acting, world: WorldState) -> None:
        if world.step:
            return
        if method.seed == 0:
            asked.set()
            assert burnt.wait(PATIENCE)
        else:
            assert asked.wait(PATIENCE)
            end = time.thread_time() + 0.1
            while time.thread_time() < end:
                pass
            burnt.set()

    results: dict[int, EpisodeResult] = {}
    given = job(use, Kept())
    job_ = Job(given.labels, given.build, lambda unit, result: results.update({unit.seed: result}))
    list(Threads().launch(UNITS[:2], job_, 2, ()))
    assert results[0].decision_cpu[0] < 0.05
    assert results[1].decision_cpu[0] >= 0.1


def test_the_real_world_is_the_same_in_threads(tmp_path: Path) -> None:
    """Roads are shared, and what is worked out about them on the way."""
    from codriving.config.compose import compose
    from codriving.experiment.objects import BuildObjects

    configs = {name: compose([f"scenario={name}", "scenario.time_limit=2"]) for name in ("roundabout", "intersection")}
    build = BuildObjects(configs)
    labels = dict.fromkeys(configs, LABELS)
    units = [Unit(cell, seed) for seed in range(2) for cell in configs]

    def driven(threads: int) -> dict[Unit, str]:
        kept: dict[Unit, str] = {}

        def save(unit: Unit, result: EpisodeResult) -> None:
            kept[unit] = repr((result.record, result.decisions))

        list(Threads().launch(units, Job(labels, build, save), threads, ()))
        return kept

    assert driven(4) == driven(1)
