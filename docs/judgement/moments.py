"""Builds the judged moments: drives episodes by the rules, and sees at moments drawn by the seed what drivers do.

    python docs/judgement/moments.py docs/judgement/moments.jsonl.xz --work moments-work --each 40 --workers 2

takes the file to write, a folder in which each episode is kept (a stopped building goes on there), the number of
moments of each world at most, and the processes. The same numbers give the same file.
"""

import argparse
import json
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from itertools import islice
from pathlib import Path

from codriving.exam.moments import SEEDS, WORLDS, JudgedMoment, StoredMoments, judged_moments, written_moments
from codriving.exam.plain import plain, restored
from codriving.runs import BEHAVIOUR, write_text
from codriving.version import __version__

SHARE = 0.15  # Of the open pairs of each step, how many are taken, each pair once at most


def of_world(work: Path, world: str, each: int) -> list[JudgedMoment]:
    """Drive episodes of one world until there are enough moments."""
    return list(islice(_in_order(work, world), each))


def _in_order(work: Path, world: str) -> Iterator[JudgedMoment]:
    part = len(SEEDS) // len(WORLDS)
    first = SEEDS.start + part * list(WORLDS).index(world)
    for seed in range(first, first + part):
        file = work / f"{seed}.json"
        if not file.exists():
            write_text(file, json.dumps(plain(judged_moments(world, WORLDS[world], seed, SHARE, once=True))))
        yield from (restored(JudgedMoment, one) for one in json.loads(file.read_text(encoding="utf-8")))


def main() -> None:
    """Build and write."""
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("file", type=Path)
    asked.add_argument("--work", type=Path, required=True)
    asked.add_argument("--each", type=int, default=40)
    asked.add_argument("--workers", type=int, default=1)
    given = asked.parse_args()
    given.work.mkdir(parents=True, exist_ok=True)
    with ProcessPoolExecutor(given.workers) as pool:
        parts = pool.map(of_world, [given.work] * len(WORLDS), WORLDS, [given.each] * len(WORLDS))
        found = tuple(one for part in parts for one in part)
    about = {
        "version": __version__,
        "behaviour": str(BEHAVIOUR),
        "seeds": f"{SEEDS.start} to {SEEDS.stop - 1}, {given.each} moments at most of each of {len(WORLDS)} worlds",
    }
    given.file.write_bytes(written_moments(StoredMoments(found, about)))
    print(f"{given.file}: {len(found)} moments of {len({one.seed for one in found})} episodes")


if __name__ == "__main__":
    main()
