"""A scenario in which one CAV is left: all others drive as human drivers do, from the same starts to the same goals."""

from dataclasses import replace

import numpy as np

from codriving.datatypes.road import Road
from codriving.datatypes.scene import Scene
from codriving.datatypes.vehicle import Kind
from codriving.environment.scenarios.pace import Pace
from codriving.environment.scenarios.protocol import Scenario

DRAW = 2
"""Key of the random numbers that choose the CAV, apart from those of the scene and of the drivers."""


class OneCav:
    """Another scenario with a single CAV among human drivers."""

    def __init__(self, scenario: Scenario) -> None:
        self.scenario = scenario
        self.name = scenario.name

    @property
    def road(self) -> Road:
        """The road."""
        return self.scenario.road

    @property
    def pace(self) -> Pace:
        """Frequencies, target speeds, time limit and perception."""
        return self.scenario.pace

    def scene(self, seed: int) -> Scene:
        """Draw the scene, and which of the CAVs is the one that is left; it is called ``CAV1`` always.

        Raises:
            ScenarioError: If the vehicles cannot be placed.
        """
        scene = self.scenario.scene(seed)
        cavs = [start for start in scene.starts if start.kind is Kind.CAV]
        rng = np.random.default_rng(np.random.SeedSequence(entropy=seed, spawn_key=(DRAW,)))
        chosen = cavs[int(rng.integers(len(cavs)))]
        others = [start for start in scene.starts if start is not chosen]
        humans = (replace(start, id=f"HDV{k}", kind=Kind.HDV) for k, start in enumerate(others, 1))
        return Scene(scene.seed, (replace(chosen, id="CAV1"), *humans))
