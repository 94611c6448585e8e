"""The only loop: look, decide, drive, until the episode has an outcome."""

import traceback
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from hashlib import sha256
from time import perf_counter, thread_time
from typing import Any

from codriving.datatypes import (
    CaseMemory,
    Ending,
    EpisodeRecord,
    Interaction,
    Method,
    Outcome,
    Participant,
    Score,
    Simulator,
    Trajectory,
)
from codriving.errors import MemoryFileError, ModelError, ModelUnavailableError
from codriving.judgement import look_back
from codriving.metrics import Scorer, with_alone


@dataclass(frozen=True, slots=True)
class Labels:
    """What the records of a cell are labelled with."""

    scenario: str
    method: str
    variant: str
    reasoner: str  # What reasons: ``rules`` or the name of a model
    memory: str = ""


@dataclass(frozen=True, slots=True)
class EpisodeResult:
    """Everything that one episode leaves."""

    record: EpisodeRecord
    trajectory: Trajectory | None  # What was driven, or None if it never began
    decisions: tuple[dict[str, Any], ...]  # One line a decision step, for ``decisions.jsonl``
    seconds: float  # Wall-clock time of the episode [s]
    decision_seconds: tuple[float, ...]  # Wall-clock time of each decision [s]
    decision_cpu: tuple[float, ...] = ()  # CPU time of each decision, of the thread that decides [s]
    traceback: str = ""
    # One line a question that a language model was asked, for ``transcript.jsonl``.
    transcript: tuple[dict[str, Any], ...] = ()


@dataclass(slots=True)
class _EpisodeLog:
    """What has been noted so far; it outlives an exception in the loop."""

    begun: bool = False
    time: float = 0.0
    decisions: list[dict[str, Any]] = field(default_factory=list)
    transcript: list[dict[str, Any]] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)
    cpu: list[float] = field(default_factory=list)
    counts: dict[str, int | float] = field(default_factory=dict)

    def add(self, counts: Mapping[str, int | float], transcript: Sequence[Mapping[str, Any]]) -> None:
        """Note what a step, or a part of one, counted and asked."""
        for name, number in counts.items():
            self.counts[name] = self.counts.get(name, 0) + number
        self.transcript.extend(dict(line) for line in transcript)


def run_episode(
    environment: Simulator,
    method: Method,
    metrics: Mapping[str, Scorer],
    seed: int,
    labels: Labels,
    go_on: Callable[[], None] = lambda: None,
    memory: CaseMemory | None = None,
) -> EpisodeResult:
    """Drive one episode and score it; a memory is told which one begins.

    What goes wrong becomes a record that ends in ``error``. An interruption by the user passes through, and so does a
    language model or a memory that cannot be used any more: none of them is this episode's fault.
    """
    log, started, trace = _EpisodeLog(), perf_counter(), ""
    trajectory: Trajectory | None = None
    scores: dict[str, Score] = {}
    try:
        environment.observer = method.observer
        world = environment.reset(seed)
        log.begun = True
        if method.hands_over:
            world = environment.hand_over()
        if memory is not None:
            memory.begin(Interaction(labels.scenario, seed, labels.method, labels.variant, labels.reasoner))
        method.reset(environment.road_map, environment.driving_model, seed_of_method(seed))
        while (outcome := environment.outcome) is None:
            go_on()
            log.time = world.time
            if method.knows_drivers:
                method.be_told(environment.manners())
            before, cpu_before = perf_counter(), thread_time()
            deliberation = method.act(world)
            log.cpu.append(thread_time() - cpu_before)
            log.seconds.append(perf_counter() - before)
            log.decisions.append(deliberation.as_dict())
            log.add(deliberation.counts, deliberation.transcript)
            world = environment.step(deliberation.actions)
        log.add(*method.conclude(world, outcome))
        trajectory = environment.trajectory()
        log.add(look_back(log.decisions, trajectory, environment.road_map), [])
        if outcome.ending is not Ending.ERROR:
            measured = with_alone(trajectory, environment, seed, metrics.values())
            scores = {n: scorer.score(measured, outcome, environment.road_map) for n, scorer in metrics.items()}
    except (ModelError, MemoryFileError):
        raise
    except Exception as error:
        scores = {}
        outcome = _failure(error, log.time)
        # Where a server's failure was noticed helps no one, and what led to it may quote what the server said.
        trace = f"{outcome.message}\n" if isinstance(error, ModelUnavailableError) else traceback.format_exc()
        if log.begun:
            # What was asked in the step that broke off has been paid for, what was driven shows the cause.
            with suppress(Exception):
                log.add(*method.unfinished_step(log.time))
            with suppress(Exception):
                trajectory = environment.trajectory()
    return EpisodeResult(
        _record(
            *(labels, seed, outcome, scores, trajectory, len(log.seconds), dict(sorted(log.counts.items()))),
            misbehaving=method.misbehaving if log.begun else {},
        ),
        trajectory,
        tuple(log.decisions),
        perf_counter() - started,
        tuple(log.seconds),
        tuple(log.cpu),
        traceback=trace,
        transcript=tuple(log.transcript),
    )


def seed_of_method(seed: int) -> int:
    """Return the seed for what a method draws in an episode, from which that of the episode cannot be read."""
    return int.from_bytes(sha256(f"draws of the method, episode {seed}".encode()).digest()[:6])


def failed_result(labels: Labels, seed: int, error: BaseException, trace: str = "") -> EpisodeResult:
    """Return the result of an episode of which nothing but its failure is known."""
    return EpisodeResult(_record(labels, seed, _failure(error, 0.0)), None, (), 0.0, (), traceback=trace)


def _record(
    labels: Labels,
    seed: int,
    outcome: Outcome,
    scores: dict[str, Score] | None = None,
    trajectory: Trajectory | None = None,
    decisions: int = 0,
    counts: dict[str, int | float] | None = None,
    misbehaving: Mapping[str, str] | None = None,
) -> EpisodeRecord:
    tracks = sorted(trajectory.tracks, key=lambda track: track.id) if trajectory else ()
    styles = misbehaving or {}
    return EpisodeRecord(
        **asdict(labels),
        seed=seed,
        outcome=outcome,
        scores=scores or {},
        participants=tuple(
            Participant(t.id, t.kind.value, t.route, t.arrived, styles.get(t.id, t.style)) for t in tracks
        ),
        decisions=decisions,
        counts=counts or {},
    )


def _failure(error: BaseException, time: float) -> Outcome:
    """The outcome of an episode that could not go on, with type and text of the error on one line."""
    # It may quote what a server said, and ends up in tables and on terminals.
    text = " ".join("".join(c for c in str(error) if c.isprintable() or c.isspace()).split())
    message = f"{type(error).__name__}: {text}" if text else type(error).__name__
    return Outcome(ending=Ending.ERROR, time=time, arrivals={}, message=message)
