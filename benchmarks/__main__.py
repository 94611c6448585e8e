"""Runs every benchmark in this folder, or some: `python -m benchmarks [--only NAME ...] [--json]`."""

import argparse
import importlib
import pkgutil
import sys
from collections.abc import Callable

import benchmarks


def found() -> dict[str, Callable[[list[str]], None]]:
    """Find the benchmarks: the modules of this folder that have a ``main``, by name."""
    names = [module.name for module in pkgutil.iter_modules(benchmarks.__path__) if module.name != "__main__"]
    mains = {name: getattr(importlib.import_module(f"benchmarks.{name}"), "main", None) for name in names}
    return {name: run for name, run in mains.items() if run is not None}


def main(arguments: list[str]) -> None:
    """Run them one after another, in order of their names.

    Args:
        arguments: ``--only`` and names of some; everything else is handed to each of them.
    """
    every = found()
    parser = argparse.ArgumentParser(prog="python -m benchmarks", add_help=False, allow_abbrev=False)
    parser.add_argument("--only", nargs="+", choices=every, default=list(every), help="run these alone")
    wanted, rest = parser.parse_known_args(arguments)
    for name in every:
        if name in wanted.only:
            every[name](rest)


if __name__ == "__main__":
    main(sys.argv[1:])
