"""What a scenario has to say, and all that the rest of the program knows of it."""

from typing import Protocol

from codriving.datatypes.road import Road
from codriving.datatypes.scene import Scene
from codriving.environment.scenarios.pace import Pace


class Scenario(Protocol):
    """A road, the vehicles that a seed puts on it, and the pace of the game."""

    @property
    def name(self) -> str:
        """Name of the scenario in tables and folders."""
        ...

    @property
    def road(self) -> Road:
        """The road; the same object for every seed."""
        ...

    @property
    def pace(self) -> Pace:
        """Frequencies, target speeds, time limit and perception."""
        ...

    def scene(self, seed: int) -> Scene:
        """Draw who starts where, how fast, and with which destination.

        Raises:
            ScenarioError: If the vehicles cannot be placed.
        """
        ...
