"""Wall-clock time of many episodes side by side that wait for a model, against the longest of them driven alone."""

import json
import resource
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from threading import Event, Thread
from time import perf_counter, process_time

import codriving
from benchmarks.options import options
from benchmarks.served import served
from codriving.runs.episode_folder import read_timing

EPISODES, LATENCY = 64, 1.0
FIRST_SEED = 10_000
TIME_LIMIT = 6
"""Longest duration of an episode [s]; twice as many decisions."""
GOAL = 1.10


def drive(tokens: Sequence[str], output: Path, name: str, first: int, episodes: int) -> tuple[Path, float, float]:
    """Drive a batch as ``codriving run`` does, tables and all.

    Args:
        tokens: Settings of the model and of the scenario.
        output: Where to write.
        name: Name of the run.
        first: First seed.
        episodes: How many.

    Returns:
        The run folder, wall-clock time and CPU time [s].
    """
    before, cpu_before = perf_counter(), process_time()
    asked = [f"seed={first}", f"episodes={episodes}", f"workers={episodes}", f"output={output}", f"run={name}"]
    results = codriving.run(*tokens, *asked)
    return results.folder, perf_counter() - before, process_time() - cpu_before


def durations(folder: Path) -> dict[int, float]:
    """Return how long each episode of a run took, by seed [s]."""
    found = {int(path.name): read_timing(path) for path in folder.glob("episodes/*/*")}
    return {seed: timing.seconds for seed, timing in found.items() if timing is not None}


def longest(seconds: dict[int, float]) -> int:
    """Return the seed of the episode that took longest; the lowest of several."""
    return min(seconds, key=lambda seed: (-seconds[seed], seed))


def sockets() -> int:
    """Count the sockets that this process has open, on Linux."""
    found = 0
    for file in Path("/proc/self/fd").iterdir():
        with suppress(OSError):
            found += str(file.readlink()).startswith("socket:")
    return found


@contextmanager
def watched() -> Iterator[list[int]]:
    """Count open sockets while the ``with`` block lasts.

    Yields:
        The most that were open at once, as its last element.
    """
    most, over = [sockets()], Event()

    def watch() -> None:
        while not over.wait(0.1):
            most.append(max(most[-1], sockets()))

    thread = Thread(target=watch)
    thread.start()
    try:
        yield most
    finally:
        over.set()
        thread.join()


def measure(episodes: int = EPISODES) -> dict[str, float]:
    """Drive all, then the longest one alone.

    Returns:
        Wall-clock time of both [s], CPU time of the batch [s], the ratio, the most sockets open at once, and the
        largest memory of the process [MB].
    """
    with served(LATENCY) as tokens, tempfile.TemporaryDirectory() as folder:
        output, short = Path(folder), [*tokens, f"scenario.time_limit={TIME_LIMIT}"]
        # What a process does once belongs to neither side: imports, the first call, conflict zones of these episodes.
        drive([*tokens, "scenario.time_limit=1"], output, "first", FIRST_SEED, 1)
        drive([*short[len(tokens) :], "launcher=threads"], output, "rules", FIRST_SEED, episodes)
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        with watched() as open_sockets:
            run, batch, cpu = drive(short, output, "batch", FIRST_SEED, episodes)
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        seed = longest(durations(run))
        _, alone, _ = drive(short, output, "alone", seed, 1)
    return {
        "episodes": episodes,
        "latency": LATENCY,
        "batch": round(batch, 2),
        "batch_cpu": round(cpu, 2),
        "alone": round(alone, 2),
        "ratio": round(batch / alone, 3),
        "goal": GOAL,
        "sockets": open_sockets[-1],
        "memory": round(memory / 1024),
        "memory_before": round(before / 1024),
    }


def main(arguments: list[str]) -> None:
    """Measure and print.

    Args:
        arguments: ``--json`` prints JSON instead of a table.
    """
    wanted = options(arguments, EPISODES)
    found = measure(wanted.episodes)
    if wanted.json:
        print(json.dumps({"model_batch": found}))
        return
    print(f"model_batch: wall-clock time of {wanted.episodes} episodes side by side, latency {LATENCY:g} s [s]")
    print(f"  all {wanted.episodes}, {found['batch_cpu']:.1f} of CPU    {found['batch']:8.2f}")
    print(
        f"  the longest one alone   {found['alone']:8.2f}   the batch takes {found['ratio']:.3f} times as long "
        f"(goal {found['goal']:.2f})"
    )
    print(
        f"  open sockets at most    {found['sockets']:5}   memory of the process {found['memory']} MB, "
        f"{found['memory_before']} MB after the same episodes without a model"
    )
