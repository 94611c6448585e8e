"""What vehicles do that hold an acceleration for a while and then their speed: all motions of a game at once."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def held(speed: float, accelerations: Array, hold: float, top: float, times: Array) -> tuple[Array, Array]:
    """Return the motions that follow from several accelerations.

    Args:
        speed: Speed now [m/s].
        accelerations: The accelerations (n,) [m/s2].
        hold: How long each is held; then the speed is kept [s].
        top: Speed beyond which nobody accelerates [m/s].
        times: Times from now (k,) [s].

    Returns:
        Distance travelled (n, k) [m], and the speed at the end (n,) [m/s].
    """
    limit = np.where(accelerations > 0, max(top, speed), 0.0)
    # Whoever does not accelerate never comes to its limit.
    changing = np.where(accelerations == 0, 1.0, accelerations)
    until = np.where(accelerations == 0, hold, np.minimum((limit - speed) / changing, hold))
    last = speed + accelerations * until
    during = np.minimum(times[None, :], until[:, None])
    travelled = speed * during + accelerations[:, None] * during**2 / 2 + last[:, None] * (times[None, :] - during)
    return np.asarray(travelled), np.asarray(last)


def passage(distance: float, travelled: Array, last: Array, times: Array) -> Array:
    """Return when each motion has covered a distance.

    Args:
        distance: The distance [m].
        travelled: Distance travelled (n, k) [m].
        last: Speed at the end (n,) [m/s].
        times: Times from now, the first of them 0 (k,) [s].

    Returns:
        Time (n,) [s]; 0 if it is covered already, and inf for whoever stands before it.
    """
    if distance <= 0:
        return np.zeros(len(travelled))
    after = np.maximum((travelled < distance).sum(axis=1), 1)
    inside = after < len(times)
    k = np.minimum(after, len(times) - 1)
    rows = np.arange(len(travelled))
    begin, end = travelled[rows, k - 1], travelled[rows, k]
    share = np.where(inside, (distance - begin) / np.maximum(end - begin, 1e-9), 0.0)
    within = times[k - 1] + share * (times[k] - times[k - 1])
    moves = last > 1e-6
    beyond = times[-1] + np.where(moves, (distance - travelled[:, -1]) / np.where(moves, last, 1.0), np.inf)
    return np.asarray(np.where(inside, within, beyond))
