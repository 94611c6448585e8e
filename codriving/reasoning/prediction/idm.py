"""The Intelligent Driver Model as a yardstick: how hard a driver would accelerate behind another vehicle."""

from dataclasses import dataclass
from math import sqrt


@dataclass(frozen=True, slots=True)
class IntelligentDriver:
    """Treiber, Hennecke and Helbing (2000); the numbers are those of a brisk but careful driver."""

    gap: float = 2.0  # Distance kept at a standstill [m]
    headway: float = 1.2  # Desired time gap [s]
    acceleration: float = 2.0  # Largest acceleration [m/s2]
    deceleration: float = 3.0  # Comfortable braking [m/s2]
    hardest: float = 8.0  # Hardest braking [m/s2]

    def accelerate(self, speed: float, wanted: float, gap: float | None = None, leader: float = 0.0) -> float:
        """Return the acceleration [m/s2].

        Args:
            speed: Speed [m/s].
            wanted: Speed that is wanted [m/s].
            gap: Free distance to the vehicle ahead, None if there is none [m].
            leader: Speed of the vehicle ahead [m/s].
        """
        free = 1 - (speed / max(wanted, 0.1)) ** 4
        if gap is None:
            return max(self.acceleration * free, -self.hardest)
        closing = speed * (speed - leader) / (2 * sqrt(self.acceleration * self.deceleration))
        desired = self.gap + max(0.0, speed * self.headway + closing)
        return max(self.acceleration * (free - (desired / max(gap, 0.1)) ** 2), -self.hardest)
