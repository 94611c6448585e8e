"""Seed -> scene -> world state -> step: the paper's environment module. The only room that imports highway-env."""

from codriving.environment.highway_env_parts import import_parts

import_parts()

from codriving.environment.environment import Environment  # noqa: E402 - imports highway-env
from codriving.environment.scenarios.pace import TOP_SPEED, Pace  # noqa: E402
from codriving.environment.scenarios.placement import Crowd, place  # noqa: E402
from codriving.environment.scenarios.shapes import bend, turned  # noqa: E402

__all__ = ["TOP_SPEED", "Crowd", "Environment", "Pace", "bend", "place", "turned"]
