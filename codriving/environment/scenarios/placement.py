"""Where vehicles start: seeded rejection sampling that leaves everybody room to brake."""

from collections.abc import Callable, Hashable, Mapping

import numpy as np

from codriving.datatypes.road import Road
from codriving.datatypes.scene import Scene, Start
from codriving.datatypes.vehicle import Kind
from codriving.environment.scenarios.crowd import Crowd
from codriving.environment.scenarios.gaps import Spot, leaves_room
from codriving.errors import ScenarioError

DRAWS_PER_VEHICLE = 200
SCENES = 200

Draw = Callable[[np.random.Generator, str, Kind], Start]
"""Draws one vehicle, given its name and who drives it."""


def place(
    seed: int,
    crowd: Crowd,
    road: Road,
    draw: Draw,
    spot: Spot | None = None,
    loops: Mapping[Hashable, float] | None = None,
) -> Scene:
    """Draw a whole scene.

    Args:
        loops: Length of each lane that runs in a circle [m].

    Raises:
        ScenarioError: If the vehicles do not fit.
    """
    first = {route.id: route.lanes[0] for route in road.routes}
    where: Spot = spot or (lambda start: (first[start.route], start.position))
    rng = np.random.default_rng(np.random.SeedSequence(entropy=seed, spawn_key=(0,)))
    number = int(rng.integers(crowd.hdvs[0], crowd.hdvs[1] + 1))
    names = [(f"CAV{i + 1}", Kind.CAV) for i in range(crowd.cavs)] + [(f"HDV{i + 1}", Kind.HDV) for i in range(number)]
    for _ in range(SCENES):
        starts: list[Start] = []
        for name, kind in names:
            for _ in range(DRAWS_PER_VEHICLE):
                start = draw(rng, name, kind)
                if leaves_room(start, starts, where, crowd.spacing, loops):
                    starts.append(start)
                    break
            else:
                break
        if len(starts) == len(names):
            return Scene(seed=seed, starts=tuple(starts))
    raise ScenarioError(
        f"{road.name} with starts {crowd.start[0]:g} to {crowd.start[1]:g} m: {crowd.cavs} CAVs and {number} HDVs "
        f"do not fit with {crowd.spacing:g} m and a braking gap between them (seed {seed}); use fewer vehicles or a "
        "longer start interval"
    )
