"""Environments to learn in; makes ``choosers`` importable."""

import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import codriving
from codriving.gym.parallel import ParallelDriving

HERE = str(Path(__file__).parent)
if HERE not in sys.path:
    sys.path.insert(0, HERE)


@pytest.fixture(scope="session")
def pettingzoo_tests() -> Any:
    """PettingZoo's own tests; importing them warns of a game of theirs."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        import pettingzoo.test as tests
    return tests


@pytest.fixture(scope="module")
def make() -> Callable[..., ParallelDriving]:
    """Makes environments, and keeps those without settings of their own."""
    kept: dict[str, ParallelDriving] = {}

    def one(name: str = "intersection", *overrides: str, **settings: Any) -> ParallelDriving:
        if overrides or settings:
            return codriving.parallel_env(name, *overrides, **settings)
        if name not in kept:
            kept[name] = codriving.parallel_env(name)
        return kept[name]

    return one
