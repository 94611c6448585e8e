"""What each benchmark is told."""

import argparse
from collections.abc import Sequence
from pathlib import Path


def options(arguments: Sequence[str], episodes: int | None = None) -> argparse.Namespace:
    """Read the arguments of a benchmark: ``json``, and ``episodes`` of each scenario where there is a usual number."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks")
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.add_argument("--against", type=_checkout, help="checkout that is driven alternately with this one")
    parser.add_argument("--store", action="store_true", help="keep the ratios in benchmarks/stored.json")
    if episodes is not None:
        parser.add_argument("--episodes", type=int, default=episodes, help="episodes of each scenario")
    return parser.parse_args(arguments)


def _checkout(typed: str) -> Path:
    path = Path(typed).resolve()
    if not (path / "codriving").is_dir():
        raise argparse.ArgumentTypeError(f"{typed} has no folder codriving; name a checkout")
    return path
