"""What a car can do: how hard it accelerates, brakes and turns."""

from dataclasses import dataclass
from math import exp, sqrt

BODY = 2.0  # Width of a vehicle [m]


@dataclass(frozen=True, slots=True)
class VehicleLimits:
    """Limits that hold for CAVs and human drivers alike.

    Raises:
        ValueError: If a value is out of range.
    """

    acceleration: float  # Hardest acceleration [m/s2]
    braking: float  # Hardest braking [m/s2]
    lateral: float  # Largest lateral acceleration that the tyres hold [m/s2]
    comfort_lateral: float  # Lateral acceleration for which a curve or a lane change is planned [m/s2]
    comfort_braking: float  # Braking before a curve [m/s2]

    def __post_init__(self) -> None:
        for name, low, high in (
            ("acceleration", 1, 12),
            ("braking", 3, 12),
            ("lateral", 2, 12),
            ("comfort_lateral", 0.5, 12),
            ("comfort_braking", 0.5, 12),
        ):
            if not low <= getattr(self, name) <= high:
                raise ValueError(f"{name} must be {low:g} to {high:g} m/s2, got {getattr(self, name):g}")
        for name, most in (("comfort_lateral", "lateral"), ("comfort_braking", "braking")):
            own, other = getattr(self, name), getattr(self, most)
            if own > other:
                raise ValueError(f"{name} must be at most {most} ({other:g} m/s2), got {own:g} m/s2")

    def change_gains(self, width: float) -> tuple[float, float]:
        """Return the gains of heading and lateral offset [1/s] with which a vehicle changes lanes.

        The two together make the lateral offset obey y'' = -K_h (y' + K_l y). K_h = 4 K_l damps it critically, and the
        lateral acceleration is largest at the beginning: K_h K_l times the width of the lane [m].
        """
        lateral = sqrt(self.comfort_lateral / (4 * width))
        return 4 * lateral, lateral

    def clears_after(self, width: float, offset: float | None = None) -> float:
        """Return how long it takes until the body of a vehicle that changes lanes is off the lane that it leaves [s].

        Args:
            width: Width of the lane [m].
            offset: Distance that is left to the centre of the new lane [m]; None for all of the width.
        """
        ends, begins = ((_way(share / width)) for share in (width / 2 - BODY / 2, width if offset is None else offset))
        return max(ends - begins, 0.0) / (self.change_gains(width)[0] / 2)


def _way(share: float) -> float:
    """Return where (1 + x) exp(-x), the share of a critically damped motion that is left, has fallen to a value."""
    low, high = 0.0, 20.0
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if (1 + middle) * exp(-middle) > share else (low, middle)
    return high
