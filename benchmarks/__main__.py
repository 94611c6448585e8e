"""Runs every benchmark in this folder: `python -m benchmarks [--json]`."""

import importlib
import pkgutil
import sys

import benchmarks


def main(arguments: list[str]) -> None:
    """Run them one after another, in order of their names.

    Args:
        arguments: Handed to each of them.
    """
    for module in pkgutil.iter_modules(benchmarks.__path__):
        run = getattr(importlib.import_module(f"benchmarks.{module.name}"), "main", None)
        if module.name != "__main__" and run is not None:
            run(arguments)


if __name__ == "__main__":
    main(sys.argv[1:])
