"""``python -m tests.fuzz``: command lines, damaged files and odd processes drawn by a seed; none may show a traceback.

A line ends with an exit code and, if it was refused, with one line that says what, why and the cure. A fault that no
message was written for counts as one, unless it began in a plug-in.
"""

import argparse
import random
import shutil
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.fuzz.damage import damaged_file, make_files
from tests.fuzz.drawing import Drawing
from tests.fuzz.place import make_place
from tests.fuzz.surroundings import surroundings
from tests.fuzz.trial import quiet_home, tried

# A draw, by the folder in which it is tried: what it was, how it ended, and what was wrong with it.
Draw = Callable[[random.Random, Path], tuple[str, str, str]]


def line(draw: random.Random, folder: Path) -> tuple[str, str, str]:
    """Try a command line in this process."""
    typed = Drawing(draw).line()
    trial = tried(typed, folder)
    return f"{typed[0][:20]}", f"exit code {trial.code}", trial.fault and f"{_short(typed)}: {trial.fault}"


def file(draw: random.Random, folder: Path) -> tuple[str, str, str]:
    """Damage a file and try what reads it."""
    name, how, typed = damaged_file(draw, folder)
    trial = tried(typed, folder)
    what = f"{name}, {how}, {_short(typed)}"
    return Path(name).name, f"exit code {trial.code}", trial.fault and f"{what}: {trial.fault}"


def process(draw: random.Random, folder: Path) -> tuple[str, str, str]:
    """Try a process with odd streams and variables."""
    drawn = surroundings(draw)
    fault = drawn.fault(folder)
    return drawn.line.split()[0], "process", fault and f"{drawn}: {fault}"


def _short(typed: list[str]) -> str:
    return " ".join(f"{word!r:.80}" for word in typed)


def draws(kind: Draw, seed: int, count: int, place: Path) -> Iterator[tuple[str, str, str]]:
    """Make so many draws of a kind, each in a copy of a place."""
    for number in range(count):
        copy = place.with_name("copy")
        shutil.copytree(place, copy, symlinks=True)
        try:
            yield kind(random.Random(f"{kind.__name__} {seed} {number}"), copy)
        finally:
            shutil.rmtree(copy)


@contextmanager
def a_place() -> Iterator[Path]:
    """Make the folder whose copies are fuzzed in."""
    with tempfile.TemporaryDirectory(prefix="codriving-fuzz-") as folder, quiet_home(Path(folder, "home")):
        # Under the name of the copies, since some files hold the path.
        made = Path(folder, "copy")
        make_place(made)
        make_files(made)
        yield made.rename(Path(folder, "place"))


def main() -> int:
    """Draw, try and count."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    parser.add_argument("--seed", type=int, default=0)
    for name, count in (("lines", 500), ("files", 200), ("processes", 30)):
        parser.add_argument(f"--{name}", type=int, default=count)
    options = parser.parse_args()
    faults: list[str] = []
    with a_place() as place:
        for kind, count in ((line, options.lines), (file, options.files), (process, options.processes)):
            began, counted = time.monotonic(), Counter[str]()
            for what, how, fault in draws(kind, options.seed, count, place):
                counted[f"{what}: {how}"] += 1
                if fault:
                    faults.append(f"{kind.__name__}: {fault}")
                    print(faults[-1], flush=True)
            print(f"\n{count} of the kind {kind.__name__}, {time.monotonic() - began:.0f} s (seed {options.seed})")
            for text, number in sorted(counted.items(), key=lambda pair: -pair[1])[:25]:
                print(f"{number:5d} {text}", flush=True)
    print(f"\n{len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
