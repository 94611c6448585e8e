"""Was the CAV of a collision hit from behind by a human driver, who had been following it?"""

import numpy as np

from codriving.datatypes import Kind, Outcome, Track, Trajectory

FOLLOWED = 2.0  # How long the one that is hit has to have been ahead, on the way of the other one [s]

BESIDE = 1.5  # How far beside that way it may have been [m]


def struck_from_behind(trajectory: Trajectory, outcome: Outcome) -> bool:
    """Whether the episode ended as a human driver ran into a CAV that had been ahead of it for 2 s.

    A CAV that has just changed lanes or turned in front of the driver, or crosses its way, does not count.
    """
    collision = outcome.collision
    tracks = {track.id: track for track in trajectory.tracks}
    if collision is None or not {collision.striker, collision.struck} <= tracks.keys():
        return False
    striker, struck = tracks[collision.striker], tracks[collision.struck]
    if striker.kind is not Kind.HDV or struck.kind is not Kind.CAV:
        return False
    rows = round(FOLLOWED / trajectory.step) + 1
    x, y, heading = striker.x[-1], striker.y[-1], striker.heading[-1]
    if np.cos(struck.heading[-1] - heading) < np.cos(np.pi / 4):
        return False
    # Its way: where it drove, and straight on from there.
    on = np.arange(0.0, striker.length + struck.length, 0.5)
    way_x = np.concatenate((striker.x, x + on * np.cos(heading)))
    way_y = np.concatenate((striker.y, y + on * np.sin(heading)))
    beside = np.hypot(struck.x[-rows:, None] - way_x, struck.y[-rows:, None] - way_y).min(axis=1)
    both = min(rows, len(striker.x), len(struck.x))
    return bool((beside <= BESIDE).all() and all(_ahead(striker, struck, k) for k in range(1, both + 1)))


def _ahead(one: Track, other: Track, k: int) -> bool:
    """Whether another vehicle was ahead of one, k rows before the end."""
    dx, dy = other.x[-k] - one.x[-k], other.y[-k] - one.y[-k]
    return bool(dx * np.cos(one.heading[-k]) + dy * np.sin(one.heading[-k]) > 0)
