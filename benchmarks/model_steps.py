"""Wall-clock time of a decision step that asks a model for an order and for decisions, against two latencies."""

import json
from collections.abc import Iterator, Sequence
from itertools import combinations_with_replacement, count, islice
from statistics import median
from time import perf_counter, process_time

from benchmarks.options import options
from benchmarks.served import served
from codriving.config.compose import compose
from codriving.environment.environment import Environment
from codriving.experiment.objects import make_objects
from codriving.methods.codriving import CoDriving

CAVS = 4
FIRST_SEED = 10_000
DECISIONS = 2
"""Decisions of each episode; at its beginning nothing is agreed on, so that all are asked."""
STEPS = {1.0: 9, 0.2: 25}
"""Steps to measure, by latency [s]."""
GOALS = {1.0: 1.05, 0.2: 1.15}
"""Most that a step may take, in latencies of the two calls one after the other, by latency [s]."""


def steps(tokens: Sequence[str]) -> Iterator[tuple[float, float]]:
    """Begin episode after episode; only steps that asked for both an order and decisions count.

    Args:
        tokens: Settings of the model.

    Yields:
        Wall-clock time and CPU time of one step [s].
    """
    config = compose([f"scenario.cavs={CAVS}", *tokens])
    environment, method, *_ = make_objects(config)
    assert isinstance(environment, Environment)
    assert isinstance(method, CoDriving)
    # Conflict zones are worked out once a process.
    for one, other in combinations_with_replacement(environment.road_map.routes, 2):
        environment.road_map.zones(one, other)
    chat = method.llm.chat()
    assert chat is not None
    chat.preflight()  # type: ignore[attr-defined]
    for seed in count(FIRST_SEED):
        world = environment.reset(seed)
        method.reset(environment.road_map, environment.driving_model, seed)
        for _ in range(DECISIONS):
            before, cpu_before = perf_counter(), process_time()
            deliberation = method.act(world)
            seconds, cpu = perf_counter() - before, process_time() - cpu_before
            if {line["purpose"] for line in deliberation.transcript} == {"negotiate", "decide"}:
                yield seconds, cpu
            world = environment.step(deliberation.actions)


def ratio(seconds: Sequence[float], latency: float) -> float:
    """Compare steps with two calls one after the other.

    Args:
        seconds: Wall-clock time of each step [s].
        latency: How long every answer takes [s].
    """
    return round(median(seconds) / (2 * latency), 3)


def measure(latency: float, number: int) -> dict[str, float]:
    """Drive until so many steps have been measured.

    Args:
        latency: How long every answer takes [s].
        number: How many steps.

    Returns:
        Their number, median, longest and CPU time [s], and the median over two latencies.
    """
    with served(latency) as tokens:
        # The first one opens connections.
        measured = list(islice(steps(tokens), 1, number + 1))
    seconds = [wall for wall, _ in measured]
    return {
        "latency": latency,
        "steps": number,
        "median": round(median(seconds), 3),
        "longest": round(max(seconds), 3),
        "cpu": round(median(cpu for _, cpu in measured), 3),
        "ratio": ratio(seconds, latency),
        "goal": GOALS[latency],
    }


def main(arguments: list[str]) -> None:
    """Measure and print.

    Args:
        arguments: ``--json`` prints JSON instead of a table.
    """
    wanted = options(arguments)
    rows = [measure(latency, number) for latency, number in STEPS.items()]
    if wanted.json:
        print(json.dumps({"model_steps": rows}))
        return
    print(f"model_steps: wall-clock time of a decision step with {CAVS} CAVs that asks for order and decisions [s]")
    for row in rows:
        print(
            f"  latency {row['latency']:.1f}   median of {row['steps']:2} steps {row['median']:.3f}, of it CPU "
            f"{row['cpu']:.3f}   longest {row['longest']:.3f}   {row['ratio']:.3f} times two "
            f"latencies (goal {row['goal']:.2f})"
        )
