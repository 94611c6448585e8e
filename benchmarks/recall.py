"""Memory at scale: time to recall for four CAVs, and to open the file, against the number of experiences (goal 9)."""

import json
import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from time import perf_counter

import numpy as np

from benchmarks.options import options
from codriving.datatypes.experience import Description, Effect, Experience, Interaction, Verdict
from codriving.datatypes.world import Action
from codriving.memory.embedders import FeatureEmbedder
from codriving.memory.snapshot import open_snapshot
from codriving.memory.store import MemoryStore

SIZES = (1_000, 10_000, 100_000)
QUERIES, ROUNDS, CAVS, SHOTS = 40, 3, 4, 5
LIMITS = {"recall_ms": 10.0, "open_s": 2.0}
"""What is to be reached with the largest memory."""


def situations(seed: int, n: int) -> list[Description]:
    """Draw situations that differ in every number.

    Args:
        seed: Seed of the draw.
        n: How many.
    """
    rng = np.random.default_rng(seed)
    numbers = rng.uniform(0.0, 20.0, size=(n, 8)).round(3)
    names = ("speed", "target", "mine", "its", "my_ttcp", "its_ttcp", "dttcp", "lead_gap")
    relations, orders = rng.integers(0, 3, size=n), rng.integers(0, 2, size=n)
    return [
        Description(
            "A scene of about the length that a scene has, so that the file is as large as it would be. " * 3,
            "A conflict of about the length that a conflict has. " * 3,
            "An order.",
            dict(zip(names, row, strict=True)),
            {"relation": ("crossing", "converging", "weaving")[r], "order": ("first", "second")[o], "driver": "CAV"},
        )
        for row, r, o in zip(numbers.tolist(), relations.tolist(), orders.tolist(), strict=True)
    ]


def fill(path: Path, size: int) -> None:
    """Write a memory of so many experiences, a hundred an interaction.

    Args:
        path: The file.
        size: Number of experiences.
    """
    experiences = [
        Experience(d, Action.FASTER, Verdict.INTENSIFIED, Effect(), "A lesson.", k % 100, "CAV1")
        for k, d in enumerate(situations(0, size))
    ]
    vectors = FeatureEmbedder().embed([e.description for e in experiences])
    # With a likeness that is never reached nothing is merged, so that there are as many as were asked for.
    with MemoryStore(path, FeatureEmbedder(), 1.1) as store:
        for k in range(0, size, 5_000):
            part = [replace(e, step=j) for j, e in enumerate(experiences[k : k + 5_000])]
            store.add(Interaction("bench", k, "bench", "", "rules"), part, vectors[k : k + 5_000])


def measure(size: int, folder: Path) -> dict[str, float]:
    """Fill a memory, open it and recall from it.

    Args:
        size: Number of experiences.
        folder: Where the file is written.

    Returns:
        Median time to recall for four CAVs, embedding included [ms], time to open [s], and size of the file [MB].
    """
    path = folder / f"{size}.sqlite"
    fill(path, size)
    opened = []
    for _ in range(ROUNDS):
        before = perf_counter()
        snapshot = open_snapshot(path, FeatureEmbedder())
        opened.append(perf_counter() - before)
    told, times = situations(1, QUERIES * CAVS), []
    for k in range(QUERIES):
        before = perf_counter()
        snapshot.search(FeatureEmbedder().embed(told[k * CAVS : (k + 1) * CAVS]), SHOTS, 0.0)
        times.append(1e3 * (perf_counter() - before))
    assert len(snapshot) == size
    return {
        "recall_ms": round(float(np.median(times)), 2),
        "open_s": round(min(opened), 3),
        "file_mb": round(path.stat().st_size / 1e6, 1),
    }


def table(found: dict[int, dict[str, float]]) -> Sequence[str]:
    """Write the measurements as lines.

    Args:
        found: Measurements by number of experiences.
    """
    goals = f"goals at {max(found):,}: {LIMITS['recall_ms']:g} ms and {LIMITS['open_s']:g} s"
    lines = [f"recall: {SHOTS} memories for each of {CAVS} CAVs; {goals}"]
    for size, one in found.items():
        lines.append(
            f"  {size:>8,} experiences   recall {one['recall_ms']:6.2f} ms   opening {one['open_s']:6.3f} s"
            f"   file {one['file_mb']:6.1f} MB"
        )
    return lines


def main(arguments: list[str]) -> None:
    """Measure and print.

    Args:
        arguments: ``--json`` prints JSON instead of a table.
    """
    wanted = options(arguments)
    with tempfile.TemporaryDirectory() as folder:
        found = {size: measure(size, Path(folder)) for size in SIZES}
    if wanted.json:
        print(json.dumps({"recall": found}))
    else:
        print("\n".join(table(found)))
