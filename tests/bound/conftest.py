"""Worlds whose scenes are bounded; makes ``bounded_results`` importable."""

import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from codriving.bound.world import BoundedWorld, bounded_world
from codriving.config.build import build
from codriving.config.compose import compose

HERE = str(Path(__file__).parent)
if HERE not in sys.path:
    sys.path.insert(0, HERE)


@pytest.fixture(scope="session")
def world() -> Callable[..., BoundedWorld]:
    """Gives the bounded world of some overrides, made once."""
    known: dict[tuple[str, ...], BoundedWorld] = {}

    def made(*overrides: str) -> BoundedWorld:
        if overrides not in known:
            known[overrides] = bounded_world(build(compose(overrides)["environment"], object))
        return known[overrides]

    return made
