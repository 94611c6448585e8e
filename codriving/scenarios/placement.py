"""Where vehicles may start: seeded rejection sampling that leaves everybody room to brake."""

import math
from collections.abc import Callable, Sequence

import numpy as np

from codriving.datatypes.scene import Scene, Start
from codriving.datatypes.vehicle import Kind
from codriving.errors import ScenarioError

LENGTH = 5.0
"""Vehicle length [m]."""

DRAWS_PER_VEHICLE = 200
SCENES = 50

Draw = Callable[[np.random.Generator, str, Kind], Start]
Spot = Callable[[Start], tuple[str, float]]


def braking_gap(follower: float, leader: float) -> float:
    """Smallest bumper gap at which a follower can still brake behind its leader.

    Args:
        follower: Speed of the vehicle behind [m/s].
        leader: Speed of the vehicle ahead [m/s].

    Returns:
        2 m plus 0.8 s of travel plus the difference of the stopping distances at 4 m/s2 [m].
    """
    return 2.0 + 0.8 * follower + max(0.0, (follower**2 - leader**2) / 8.0)


def leaves_room(start: Start, others: Sequence[Start], spot: Spot, spacing: float) -> bool:
    """Whether a start keeps its distance from the others on the same lane.

    Args:
        start: The candidate.
        others: Starts already placed.
        spot: Maps a start to the lane group it stands on and its place along it [m].
        spacing: Smallest distance between two centres [m].
    """
    lane, place = spot(start)
    for other in others:
        lane_2, place_2 = spot(other)
        if lane != lane_2:
            continue
        distance = abs(place - place_2)
        ahead, behind = (start, other) if place > place_2 else (other, start)
        if distance < max(spacing, LENGTH + braking_gap(behind.speed, ahead.speed)):
            return False
    return True


def room_on_lane(length: float, slowest: float, spacing: float) -> int:
    """Largest number of vehicles that can start on one lane, even if all draws fall as they should.

    Args:
        length: Length of the start interval [m].
        slowest: Lowest start speed [m/s].
        spacing: Smallest distance between two centres [m].
    """
    return 1 + math.floor(length / max(spacing, LENGTH + braking_gap(slowest, slowest)))


def place(seed: int, cavs: int, hdvs: tuple[int, int], draw: Draw, spot: Spot, spacing: float, what: str) -> Scene:
    """Draw a whole scene.

    Args:
        seed: Seed of the episode.
        cavs: Number of CAVs.
        hdvs: Smallest and largest number of HDVs; the number is drawn from the seed.
        draw: Draws one vehicle.
        spot: Maps a start to the lane group it stands on and its place along it [m].
        spacing: Smallest distance between two centres [m].
        what: Words for the message if the scene is too full.

    Raises:
        ScenarioError: If the vehicles do not fit.
    """
    rng = np.random.default_rng(np.random.SeedSequence(entropy=seed, spawn_key=(0,)))
    number = int(rng.integers(hdvs[0], hdvs[1] + 1))
    names = [(f"CAV{i + 1}", Kind.CAV) for i in range(cavs)] + [(f"HDV{i + 1}", Kind.HDV) for i in range(number)]
    for _ in range(SCENES):
        starts: list[Start] = []
        for name, kind in names:
            for _ in range(DRAWS_PER_VEHICLE):
                start = draw(rng, name, kind)
                if leaves_room(start, starts, spot, spacing):
                    starts.append(start)
                    break
            else:
                break
        if len(starts) == len(names):
            return Scene(seed=seed, starts=tuple(starts))
    raise ScenarioError(
        f"{what}: {cavs} CAVs and {number} HDVs do not fit with {spacing:g} m and a braking gap between them "
        f"(seed {seed}); use fewer vehicles or a longer start interval"
    )
