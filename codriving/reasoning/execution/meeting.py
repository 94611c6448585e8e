"""Where one CAV has to let another one go first, and which of its plans do."""

from dataclasses import dataclass

import numpy as np

from codriving.geometry.zone import ConflictZone
from codriving.reasoning.execution.violations import Array, Steps, passes_too_early


@dataclass(frozen=True, slots=True)
class Meeting:
    """A stretch that two CAVs share.

    Attributes:
        place: Its arc length [m].
        there: Arc length of the one that goes first [m].
        pad: Additional room along the route [m].
    """

    zones: tuple[ConflictZone, ...]
    place: float
    there: float
    until: int
    lag: int
    pad: float
    smaller: tuple[tuple[ConflictZone, ...], ...] = ()

    def steps(self, travels: Array, first: Array) -> Steps:
        """Return when each plan first comes too close.

        Args:
            travels: Distance of each plan over time (plans, n) [m].
            first: Distance of the one that goes first over time (n,) [m].

        Returns:
            Step of the first violation (plans,); n where there is none.
        """
        found = self._in(self.zones, travels, first, self.lag, self.pad)
        for k, zones in enumerate(self.smaller):
            if found.any():
                break
            # As long as the bodies have room the margins stay; whoever is closer than that may only get away.
            found = self._in(zones, travels, first, *((self.lag, self.pad) if k == 0 else (0, 0.0)))
        return found

    def _in(self, zones: tuple[ConflictZone, ...], travels: Array, first: Array, lag: int, pad: float) -> Steps:
        n = travels.shape[1]
        found: Steps = np.full(len(travels), n)
        for zone in zones:
            motion = self.place + travels[:, : self.until]
            steps = passes_too_early(zone, motion, self.there + first, lag, pad)
            found = np.minimum(found, np.where(steps < self.until, steps, n))
        return found
