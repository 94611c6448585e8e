"""The only loop: look, decide, drive, until the episode has an outcome."""

import traceback
from collections import Counter
from dataclasses import dataclass, field
from time import perf_counter, process_time
from typing import Any

from codriving.datatypes.outcome import Ending, Outcome
from codriving.datatypes.record import EpisodeRecord, Participant
from codriving.datatypes.score import Score
from codriving.datatypes.trajectory import Trajectory
from codriving.episodes.protocols import Environment, Method, Metrics
from codriving.episodes.unit import Labels


@dataclass(frozen=True, slots=True)
class EpisodeResult:
    """Everything that one episode leaves.

    Attributes:
        record: What the tables are made from.
        trajectory: What was driven, or None if it never began.
        decisions: One line a decision step, for ``decisions.jsonl``.
        seconds: Wall-clock time of the episode [s].
        decision_seconds: Wall-clock time of each decision [s].
        decision_cpu: CPU time of each decision [s].
        traceback: Where it went wrong; empty if nothing did.
    """

    record: EpisodeRecord
    trajectory: Trajectory | None
    decisions: tuple[dict[str, Any], ...]
    seconds: float
    decision_seconds: tuple[float, ...]
    decision_cpu: tuple[float, ...] = ()
    traceback: str = ""


@dataclass(slots=True)
class _Log:
    """What has been noted so far; it outlives an exception in the loop."""

    begun: bool = False
    time: float = 0.0
    decisions: list[dict[str, Any]] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)
    cpu: list[float] = field(default_factory=list)
    counts: Counter[str] = field(default_factory=Counter)


def run_episode(environment: Environment, method: Method, metrics: Metrics, seed: int, labels: Labels) -> EpisodeResult:
    """Drive one episode and judge it.

    Whatever goes wrong becomes a record that ends in ``error``; only an interruption by the user passes through.

    Args:
        environment: The world.
        method: Who decides.
        metrics: What is judged by.
        seed: Seed of the episode; with the same objects it determines the result.
        labels: What the record is labelled with.

    Returns:
        Record, trajectory, decisions and timing.
    """
    log = _Log()
    started = perf_counter()
    trajectory: Trajectory | None = None
    score: Score | None = None
    trace = ""
    try:
        outcome = _drive(environment, method, seed, log)
        trajectory = environment.trajectory()
        if outcome.ending is not Ending.ERROR:
            score = metrics.score(trajectory, outcome, environment.road_map)
    except Exception as error:
        trace = traceback.format_exc()
        score = None
        outcome = failure(error, log.time)
        trajectory = _salvage(environment) if log.begun else None
    record = EpisodeRecord(
        scenario=labels.scenario,
        method=labels.method,
        variant=labels.variant,
        reasoner=labels.reasoner,
        seed=seed,
        outcome=outcome,
        score=score,
        participants=_participants(trajectory),
        decisions=len(log.seconds),
        counts=dict(sorted(log.counts.items())),
    )
    return EpisodeResult(
        record,
        trajectory,
        tuple(log.decisions),
        perf_counter() - started,
        tuple(log.seconds),
        tuple(log.cpu),
        traceback=trace,
    )


def _drive(environment: Environment, method: Method, seed: int, log: _Log) -> Outcome:
    """The loop itself."""
    world = environment.reset(seed)
    log.begun = True
    method.reset(environment.road_map, environment.driving_model, seed)
    while (outcome := environment.outcome) is None:
        log.time = world.time
        before, cpu_before = perf_counter(), process_time()
        deliberation = method.act(world)
        log.cpu.append(process_time() - cpu_before)
        log.seconds.append(perf_counter() - before)
        log.decisions.append(deliberation.as_dict())
        log.counts.update(deliberation.counts)
        world = environment.step(deliberation.actions)
    return outcome


def failure(error: BaseException, time: float) -> Outcome:
    """The outcome of an episode that could not go on.

    Args:
        error: What was raised.
        time: Simulated time of the last decision [s].

    Returns:
        An outcome that ends in ``error``, with type and text of the error on one line.
    """
    text = " ".join(str(error).split())
    message = f"{type(error).__name__}: {text}" if text else type(error).__name__
    return Outcome(ending=Ending.ERROR, time=time, arrivals={}, message=message)


def failed_result(labels: Labels, seed: int, error: BaseException, trace: str = "") -> EpisodeResult:
    """The result of an episode of which nothing but its failure is known.

    Args:
        labels: What the record is labelled with.
        seed: Seed of the episode.
        error: What was raised.
        trace: Where it was raised.

    Returns:
        A result without trajectory and decisions.
    """
    record = EpisodeRecord(
        scenario=labels.scenario,
        method=labels.method,
        variant=labels.variant,
        reasoner=labels.reasoner,
        seed=seed,
        outcome=failure(error, 0.0),
        score=None,
        participants=(),
        decisions=0,
        counts={},
    )
    return EpisodeResult(record, None, (), 0.0, (), traceback=trace)


def _salvage(environment: Environment) -> Trajectory | None:
    """What was driven before it went wrong, for whoever looks for the cause; the broken world may refuse."""
    try:
        return environment.trajectory()
    except Exception:
        return None


def _participants(trajectory: Trajectory | None) -> tuple[Participant, ...]:
    """Who took part, in order of id."""
    if trajectory is None:
        return ()
    tracks = sorted(trajectory.tracks, key=lambda track: track.id)
    return tuple(Participant(track.id, track.kind.value, track.route, track.arrived) for track in tracks)
