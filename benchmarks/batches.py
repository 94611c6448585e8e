"""Whole batches: ``--only batches [--against CHECKOUT]``.

Wall-clock time against another checkout, what a second worker is worth, how long a run takes to its first episode, and
whether the memory of a process grows.
"""

import json
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

from benchmarks.goals import Row, show
from benchmarks.options import options
from benchmarks.side import THIS, Side, surroundings

FIRST_SEED = 20_000  # Of the tuning seeds
SCENE = ("scenario=intersection", f"seed={FIRST_SEED}")
AGAINST, TIMES, SHORTER = 200, 3, 0.6
"""Episodes of a batch that another checkout drives, too, how often each drives it, and the goal."""
GAIN, START = 1.9, 1.5
"""How many times as fast two workers are to be as one, and seconds to the first episode."""
EARLIER, GROWTH = 10, 1.05
"""Memory is compared with that after a tenth of the episodes; by how much it may have grown."""


@dataclass(frozen=True, slots=True)
class Batch:
    """Seconds of a run: all of it, to the beginning of its first episode, and from there to the end of its last."""

    whole: float
    start: float
    driving: float


def batch(checkout: Path, episodes: int, workers: int, typed: Sequence[str] = ()) -> Batch:
    """Drive a batch in a process of its own, into a folder that is gone afterwards."""
    with TemporaryDirectory() as folder:
        tokens = [*SCENE, *typed, f"episodes={episodes}", f"workers={workers}", f"output={folder}"]
        command = [sys.executable, "-m", "codriving", "run", *tokens]
        began, clock = time.time(), time.perf_counter()
        subprocess.run(command, cwd=checkout, env=surroundings(checkout), check=True, capture_output=True)
        whole = time.perf_counter() - clock
        ends = {file: file.stat().st_mtime for file in Path(folder).rglob("record.json")}
        if len(ends) != episodes:
            raise RuntimeError(f"{checkout} has left {len(ends)} of {episodes} records")
        first = min(end - _seconds(file) for file, end in ends.items())
        return Batch(whole, first - began, max(ends.values()) - first)


def _seconds(record: Path) -> float:
    """Seconds that an episode took."""
    timing = record.with_name("timing.json")
    return float(json.loads(timing.read_text(encoding="utf-8"))["seconds"]) if timing.is_file() else 0.0


def against(other: Path) -> Iterator[Row]:
    """Drive the same batch by turns, each side as it comes, with two workers."""
    worlds = {"paper": ("suite=paper",), "default": ()}
    spent: dict[str, list[float]] = {name: [] for name in ("other", *worlds)}
    for _ in range(TIMES):
        spent["other"].append(batch(other, AGAINST, 2).whole)
        for name, typed in worlds.items():
            spent[name].append(batch(THIS, AGAINST, 2, typed).whole)
    for name in worlds:
        yield Row(f"{AGAINST} episodes, {name}", median(spent[name]), median(spent["other"]), "s", SHORTER)


def workers(episodes: int) -> Iterator[Row]:
    """Drive the same batch with one worker and with two."""
    one, two = (batch(THIS, episodes, count) for count in (1, 2))
    yield Row(f"{episodes} episodes, two workers", two.driving, one.driving, "s", GAIN, least=True)
    yield Row("to the first episode, two workers", two.start, START, "s", 1.0)


def memory(episodes: int) -> Iterator[Row]:
    """Drive episodes one after another in one process, and compare its memory with that at a tenth of them."""
    with Side(THIS, SCENE[:1]) as side:
        for k in range(episodes):
            side.drive(FIRST_SEED + k)
            if k + 1 == max(episodes // EARLIER, 1):
                before = side.memory()
        yield Row(f"memory after {episodes} episodes", side.memory(), before, "MB", GROWTH)


def main(arguments: list[str]) -> None:
    """Measure and print.

    Args:
        arguments: ``--episodes`` with one worker and with two; twice as many for the memory.
    """
    wanted = options(arguments, 1000)
    rows = [] if wanted.against is None else [against(wanted.against)]
    rows += [workers(wanted.episodes), memory(2 * wanted.episodes)]
    name = "" if wanted.against is None else wanted.against.name
    show("batches", name, (row for part in rows for row in part), as_json=wanted.json, store=wanted.store)
