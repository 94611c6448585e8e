"""``python -m tests.mutants``: change the reasoning in many places, one at a time, and see whether a test notices.

The changes are drawn by a seed. Each is compiled in memory, in a process of its own, where the tests that run through
the changed line are run until one fails. A change that no test notices is a *survivor*; those that are known stand in
``survivors.txt``, each with its reason, in the form in which the report prints them.
"""

import argparse
import random
import re
import sys
import time
from collections import Counter
from pathlib import Path

from tests.mutants.changes import Change, changes
from tests.mutants.forked import Outcome, reach, run

HERE = Path(__file__).parent
ROOMS = ("codriving/reasoning/safety", "codriving/reasoning/ordering", "codriving/reasoning/decision")
METHODS = ("codriving", "codriving_deliberation", "codriving_lanes", "fcfs", "idfst", "ordered", "pipeline")
TESTS = ("tests/reasoning", "tests/methods/language_model", *(f"tests/methods/test_{name}.py" for name in METHODS))
LEAST = 0.8
"""Share of the changes that has to be noticed."""


def main() -> int:
    """Draw, run and report."""
    options = _options()
    root = options.root.resolve()
    files = [p for room in options.rooms for p in _sources(root / room)]
    every = [c for p in files for c in changes(str(p.relative_to(root)), p.read_text(encoding="utf-8"))]
    drawn = random.Random(options.seed).sample(every, min(options.number, len(every)))
    if options.only:
        drawn = [c for c in every if re.search(options.only, f"{c.file}:{c.line} {c.key}")]
    began = time.monotonic()
    print(f"{len(every)} changes are possible in {len(files)} files; {len(drawn)} are tried (seed {options.seed})")
    reached = reach(root, options.rooms, options.tests)
    print(f"{len(reached.seconds)} tests pass without a change, {time.monotonic() - began:.0f} s", flush=True)
    outcomes: list[tuple[Change, Outcome]] = []
    for change, outcome in run(root, drawn, reached, options.workers):
        outcomes.append((change, outcome))
        if outcome.noticed and not options.verbose:
            continue
        print(
            f"{len(outcomes):4d} {'noticed' if outcome.noticed else 'SURVIVES'} {_line(change)}  [{outcome.by}]",
            flush=True,
        )
    return _report(outcomes, time.monotonic() - began, options.known)


def _report(outcomes: list[tuple[Change, Outcome]], took: float, known: Path) -> int:
    reasons = _known(known)
    survivors = [c for c, o in outcomes if not o.noticed]
    kinds = Counter(c.kind for c, _ in outcomes)
    missed = Counter(c.kind for c in survivors)
    print("\nkind                  tried  noticed")
    for kind, number in sorted(kinds.items()):
        print(f"{kind:20s} {number:6d} {number - missed[kind]:8d}")
    unexplained = [c for c in survivors if c.key not in reasons]
    if survivors:
        print(f"\n{len(survivors)} survivors, {len(unexplained)} of them without a reason in {known.name}:")
    for change in sorted(survivors, key=lambda c: (c.file, c.line)):
        print(f"{change.key}\n    {reasons.get(change.key, 'no reason is known')}")
    noticed = len(outcomes) - len(survivors)
    share = noticed / max(len(outcomes), 1)
    print(f"\n{noticed} of {len(outcomes)} changes noticed: {share:.1%}, in {took / 60:.1f} minutes")
    if share < LEAST:
        print(f"at least {LEAST:.0%} have to be noticed", file=sys.stderr)
        return 1
    return 0


def _sources(room: Path) -> list[Path]:
    return sorted(room.rglob("*.py")) if room.is_dir() else [room]


def _line(change: Change) -> str:
    return f"{change.file}:{change.line} {change.where}: {change.old}  ->  {change.new}  in  {change.text}"


def _known(file: Path) -> dict[str, str]:
    """Return the reasons of the survivors that are known: a line of change, a line of reason below it."""
    if not file.exists():
        return {}
    lines = [line for line in file.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
    return {change: reason.strip() for change, reason in zip(lines[::2], lines[1::2], strict=True)}


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.mutants", description=__doc__)
    parser.add_argument("--number", type=int, default=300, help="how many changes are tried")
    parser.add_argument("--seed", type=int, default=1, help="draws them")
    parser.add_argument("--workers", type=int, default=2, help="changes that are tried at a time")
    parser.add_argument("--only", default="", help="try the changes in whose file, line or text this pattern is found")
    parser.add_argument("--root", type=Path, default=HERE.parents[1], help="the repository")
    parser.add_argument("--rooms", nargs="+", default=ROOMS, help="what is changed")
    parser.add_argument("--tests", nargs="+", default=TESTS, help="what has to notice it")
    parser.add_argument("--known", type=Path, default=HERE / "survivors.txt", help="survivors with their reasons")
    parser.add_argument("--verbose", action="store_true", help="print what is noticed, too")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
