"""A flow: vehicles that keep coming in, and are counted in a window after a warm-up."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Flow:
    """How vehicles come in on every lane that leads into the road, and when they are counted.

    Raises:
        ValueError: If a value is out of range.
    """

    arrivals: float  # Vehicles that want to come in, per hour and lane [1/h]
    share: float  # Share of CAVs among them
    headway: float  # Smallest time between two of them on one lane [s]
    warm_up: float  # Time until the window begins [s]
    window: float  # Time in which is counted [s]

    def __post_init__(self) -> None:
        for name, low, high, unit in (
            ("arrivals", 1, 3600, " vehicles per hour and lane"),
            ("share", 0, 1, ""),
            ("headway", 0, 60, " s"),
            ("warm_up", 0, 3600, " s"),
            ("window", 10, 3600, " s"),
        ):
            if not low <= getattr(self, name) <= high:
                raise ValueError(f"{name} must be {low:g} to {high:g}{unit}, got {getattr(self, name):g}")
        if self.mean_gap <= self.headway:
            raise ValueError(
                f"arrivals must be below 3600 / headway, {3600 / self.headway:g} vehicles per hour and lane, got "
                f"{self.arrivals:g}; lower one of the two"
            )

    @property
    def mean_gap(self) -> float:
        """Mean time between two arrivals on one lane [s]."""
        return 3600 / self.arrivals

    @property
    def ends(self) -> float:
        """Time at which the window ends [s]."""
        return self.warm_up + self.window
