"""Compares what two checkouts drive, byte for byte: ``python -m tests.sameness.decisions CHECKOUT [WORD ...]``.

The last digits in ``decisions.jsonl`` follow the kernel of the linear algebra, so there are no golden values for them.
Here both checkouts drive the same cells on the same machine, and all that they leave is compared: records,
trajectories, decisions, transcripts, memories with their vectors, and what a model was asked. With words, only the
cells in whose name one of them is. Prints a table of what differs; the exit code is 1 if anything does.
"""

import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

HERE = Path(__file__).resolve().parent
THIS = HERE.parents[1]


def start(checkout: Path, folder: Path, words: Sequence[str]) -> subprocess.Popen[bytes]:
    """Begin to drive all cells of this folder with the package of a checkout.

    Args:
        checkout: Whose package is driven.
        folder: Where the files are left.
        words: Which cells; all if there are none.
    """
    folder.mkdir()
    environment = {**os.environ, "PYTHONPATH": str(checkout), "SAMENESS": "all"}
    return subprocess.Popen([sys.executable, HERE / "driving.py", folder, *words], cwd=folder, env=environment)


def files(folder: Path) -> dict[str, Path]:
    """All files below a folder, by name."""
    return {path.relative_to(folder).as_posix(): path for path in sorted(folder.rglob("*")) if path.is_file()}


def compare(one: Path, other: Path) -> list[tuple[str, str]]:
    """Compare two folders.

    Args:
        one: Files of the other checkout.
        other: Files of this one.

    Returns:
        Each file that differs, and how.
    """
    before, now = files(one), files(other)
    found = [(name, "there only in the other checkout") for name in sorted(before.keys() - now.keys())]
    found += [(name, "there only in this checkout") for name in sorted(now.keys() - before.keys())]
    for name in sorted(before.keys() & now.keys()):
        lines, changed = before[name].read_bytes().split(b"\n"), now[name].read_bytes().split(b"\n")
        if lines != changed:
            pairs = enumerate(zip(lines, changed, strict=False), start=1)
            first = next((k for k, (a, b) in pairs if a != b), min(len(lines), len(changed)) + 1)
            found.append((name, f"differs from line {first} on"))
    return found


def main(arguments: Sequence[str]) -> int:
    """Drive and compare.

    Args:
        arguments: The other checkout, and words.

    Returns:
        Exit code.
    """
    if not arguments or not (Path(arguments[0]) / "codriving").is_dir():
        print("usage: python -m tests.sameness.decisions CHECKOUT [WORD ...]", file=sys.stderr)
        return 2
    other, words = Path(arguments[0]).resolve(), arguments[1:]
    with tempfile.TemporaryDirectory() as place:
        folders = Path(place) / "other", Path(place) / "this"
        running = [start(*pair, words) for pair in zip((other, THIS), folders, strict=True)]
        codes = [process.wait() for process in running]
        if any(codes):
            print("not all cells could be driven", file=sys.stderr)
            return 1
        left = [folder / "left" for folder in folders]
        number, found = len(files(left[1])), compare(*left)
    for name, how in found:
        print(f"{name:90} {how}")
    print(f"{number} files compared, {len(found)} differ")
    return 1 if found or not number else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
