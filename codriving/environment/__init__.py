"""Scenario to world state to step: the paper's environment module, and the only door to highway-env."""

from typing import TYPE_CHECKING

from codriving.environment.scenarios.pace import TOP_SPEED, Pace
from codriving.environment.scenarios.placement import Crowd, place
from codriving.environment.scenarios.shapes import bend, turned

if TYPE_CHECKING:
    from codriving.environment.environment import Environment

__all__ = ["TOP_SPEED", "Crowd", "Environment", "Pace", "bend", "place", "turned"]


def __getattr__(name: str) -> object:
    """Import highway-env, which takes a second, only where vehicles are driven."""
    if name != "Environment":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from codriving.environment.environment import Environment

    return Environment
