"""What chance does to messages, drawn from the seed for each link and tick, whatever method drives."""

from zlib import crc32

import numpy as np
from numpy.typing import NDArray

from codriving.v2x.settings import ChannelSettings

BLOCK = 256  # Ticks that are drawn at once

CUT = 3.0  # Noise is cut off at so many standard deviations

LINK, SENDER, TELLS, MISCONDUCT = 1, 2, 4, 7  # What a stream of numbers is for


def stream(seed: int, use: int, *names: str) -> np.random.Generator:
    """Return what is drawn for one use and some names, which does not depend on what is drawn for others."""
    return np.random.default_rng(
        np.random.SeedSequence(entropy=seed, spawn_key=(use, *(crc32(n.encode()) for n in names)))
    )


def tells(seed: int, driver: str, share: float) -> bool:
    """Whether a human driver tells its route; the same drivers do so at a larger share, and others with them."""
    return share > 0 and bool(stream(seed, TELLS, driver).random() < share)


class Link:
    """Whether and when the messages of one CAV reach another one."""

    def __init__(self, settings: ChannelSettings, seed: int, sender: str, receiver: str) -> None:
        self._settings, self._rng = settings, stream(seed, LINK, sender, receiver)
        # Not even losses that have nothing to do with one another come one by one.
        self._recovers = min(1 / settings.burst, 1 - settings.loss)
        self._fails = self._recovers * settings.loss / (1 - settings.loss)
        self._bad = bool(self._rng.random() < settings.loss)
        self._lost: list[bool] = []
        self._delays: list[float] = []

    def delay(self, tick: int) -> float:
        """Return how long the messages of a tick take [s]; inf if they are lost."""
        while tick >= len(self._lost):
            self._draw()
        return float("inf") if self._lost[tick] else self._delays[tick]

    def _draw(self) -> None:
        """Draw the next block: losses come in bursts (two states, as Gilbert and Elliott have them)."""
        shape, mean = self._settings.age_shape, self._settings.age
        for chance in self._rng.random(BLOCK).tolist():
            self._lost.append(self._bad)
            self._bad = chance >= self._recovers if self._bad else chance < self._fails
        drawn = self._rng.gamma(shape, mean / shape, BLOCK) if shape > 0 else np.full(BLOCK, mean)
        self._delays += drawn.tolist()


class Errors:
    """By how much what a CAV measures of a vehicle, itself included, is wrong."""

    def __init__(self, settings: ChannelSettings, seed: int, sender: str, vehicle: str) -> None:
        self._scale = np.array([settings.noise, settings.noise, settings.speed_noise])
        self._rng = stream(seed, SENDER, sender, vehicle)
        self._drawn: NDArray[np.float64] = np.empty((0, 3))

    def at(self, tick: int) -> tuple[float, float, float]:
        """Return what is added to x and y [m] and to the speed [m/s]."""
        while tick >= len(self._drawn):
            block = np.clip(self._rng.standard_normal((BLOCK, 3)), -CUT, CUT)
            self._drawn = np.concatenate((self._drawn, block * self._scale))
        x, y, speed = self._drawn[tick].tolist()
        return x, y, speed
