"""What each benchmark is told."""

import argparse
from collections.abc import Sequence


def options(arguments: Sequence[str], episodes: int | None = None) -> argparse.Namespace:
    """Read the arguments of a benchmark: ``json``, and ``episodes`` of each scenario where there is a usual number."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks")
    parser.add_argument("--json", action="store_true", help="print JSON")
    if episodes is not None:
        parser.add_argument("--episodes", type=int, default=episodes, help="episodes of each scenario")
    return parser.parse_args(arguments)
