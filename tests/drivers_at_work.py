"""What a human driver does at the junction among others who only keep their speed."""

from collections.abc import Callable

import numpy as np

from codriving.datatypes.world import Action
from codriving.environment.environment import Environment


class Crossing:
    """What a human driver does among others who only keep their speed.

    Attributes:
        lines: When the centre of each vehicle is at the line of its junction [s]; inf if it never is.
        speeds: Speed of HDV1 over time [m/s].
        pedals: Its acceleration over time [m/s2].
    """

    def __init__(self, env: Environment, hold: Callable[[Environment], None] | None = None) -> None:
        world = env.reset(0)
        while env.outcome is None:
            if hold is not None:
                hold(env)
            world = env.step({cav.id: Action.IDLE for cav in world.cavs})
        tracks = env.trajectory().tracks
        self.ending = env.outcome.ending
        self.lines = {}
        for track in tracks:
            places = [env.road_map.project(track.route, x, y)[0] for x, y in zip(track.x, track.y, strict=True)]
            over = np.flatnonzero(np.array(places) >= env.road_map.routes[track.route].entry)
            self.lines[track.id] = float(over[0]) * 0.1 if len(over) else float("inf")
        human = next(track for track in tracks if track.id == "HDV1")
        self.speeds, self.pedals = human.speed, human.acceleration

    @property
    def brakes(self) -> float:
        """When HDV1 first brakes [s]."""
        found = np.flatnonzero(self.pedals < -1.0)
        return float(found[0]) * 0.1 if len(found) else float("inf")
