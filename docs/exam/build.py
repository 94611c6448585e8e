"""Builds the exam: drives episodes by the rules, and judges at moments drawn by the seed what can be answered there.

    python docs/exam/build.py codriving/exam/exam.jsonl.xz --work exam-work --episodes 20 --workers 2

    python docs/exam/build.py part.jsonl.xz --work exam-work --episodes 1 --worlds roundabout,merge

takes the file to write, a folder in which each episode is kept once it is judged (a stopped building goes on there),
the number of episodes of each world at most, and the processes. The same number of episodes gives the same file.
"""

import argparse
from pathlib import Path

from codriving.exam.building import build_exam
from codriving.exam.file import written_exam
from codriving.version import __version__


def main() -> None:
    """Build and write."""
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("file", type=Path)
    asked.add_argument("--work", type=Path, required=True)
    asked.add_argument("--episodes", type=int, default=20)
    asked.add_argument("--worlds", default="", help="names, with commas between; all if not given")
    asked.add_argument("--workers", type=int, default=1)
    given = asked.parse_args()
    about = {"version": __version__}
    exam = build_exam(given.work, given.episodes, given.workers, given.worlds.split(",") * bool(given.worlds), about)
    given.file.write_bytes(written_exam(exam))
    print(f"{given.file}: {len(exam.situations)} situations, {len(exam.negotiations)} negotiations")


if __name__ == "__main__":
    main()
