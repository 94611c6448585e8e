"""The Intelligent Driver Model as a yardstick: how hard a driver would accelerate behind another vehicle."""

from dataclasses import dataclass
from math import sqrt

from codriving.datatypes import TrackedVehicle, VehicleState

Pair = tuple[TrackedVehicle | None, TrackedVehicle | None]  # The vehicles next ahead and behind on a lane


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

    def follow(self, speed: float, wanted: float, ahead: TrackedVehicle | None) -> float:
        """Return the acceleration behind a vehicle whose gap is known, and otherwise on a free road [m/s2].

        Args:
            speed: Speed [m/s].
            wanted: Speed that is wanted [m/s].
        """
        if ahead is None or ahead.gap is None:
            return self.accelerate(speed, wanted)
        return self.accelerate(speed, wanted, ahead.gap, ahead.speed)

    def incentive(self, ego: VehicleState, wanted: float, here: Pair, there: Pair, politeness: float) -> float:
        """Return MOBIL's incentive of a lane change (Kesting, Treiber and Helbing, 2007).

        Args:
            wanted: Speed that is wanted [m/s].
            here: The vehicles next ahead and behind on the present lane.
            there: The same on the other lane.
            politeness: Weight of what those behind gain or lose.

        Returns:
            What the vehicle gains, and politely what those behind it on both lanes do [m/s2].
        """
        own = self.follow(ego.speed, wanted, there[0]) - self.follow(ego.speed, wanted, here[0])
        others = 0.0
        for (ahead, behind), sign in ((there, 1), (here, -1)):
            if behind is not None and behind.gap is not None:
                free = None if ahead is None else (ahead.gap or 0.0) + behind.gap + ego.length
                alone = self.accelerate(behind.speed, wanted, free, ahead.speed if ahead else 0.0)
                others += sign * (self.accelerate(behind.speed, wanted, behind.gap, ego.speed) - alone)
        return own + politeness * others
