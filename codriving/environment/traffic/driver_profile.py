"""How the human drivers of a run drive: the parameters of IDM and MOBIL."""

from dataclasses import dataclass

from highway_env.vehicle.behavior import IDMVehicle

from codriving.errors import ConfigError


@dataclass(frozen=True, slots=True)
class DriverProfile:
    """Parameters of the Intelligent Driver Model and of MOBIL.

    Attributes:
        acceleration: IDM's comfortable acceleration a [m/s2].
        deceleration: IDM's comfortable deceleration b [m/s2].
        limit: Hardest acceleration or braking that a driver can do [m/s2].
        jam_distance: Distance between the centres of two standing cars [m].
        headway: Desired time gap [s].
        sight: How far ahead along the route a driver looks for bodies [m].
        gain_threshold: MOBIL's smallest gain for a lane change [m/s2].
        safe_braking: MOBIL's hardest braking imposed on the new follower [m/s2].

    Raises:
        ConfigError: If a value is out of range.
    """

    acceleration: float
    deceleration: float
    limit: float
    jam_distance: float
    headway: float
    sight: float
    politeness: float
    gain_threshold: float
    safe_braking: float

    def __post_init__(self) -> None:
        ranges = {
            "acceleration": (0.1, 10),
            "deceleration": (0.1, 10),
            "limit": (1, 12),
            "jam_distance": (5.5, 30),
            "headway": (0.1, 5),
            "sight": (10, 300),
            "politeness": (0, 1),
            "gain_threshold": (0, 5),
            "safe_braking": (0.1, 9),
        }
        for name, (low, high) in ranges.items():
            value = getattr(self, name)
            if not low <= value <= high:
                raise ConfigError(f"drivers.{name} must be {low:g} to {high:g}, got {value:g}")

    def apply(self, driver: IDMVehicle, to_class: bool) -> None:
        """Set the parameters.

        Args:
            to_class: Set them on the class instead, as highway-env's intersection does (a fault kept for comparison).
        """
        target = type(driver) if to_class else driver
        target.COMFORT_ACC_MAX = self.acceleration
        target.COMFORT_ACC_MIN = -self.deceleration
        target.ACC_MAX = self.limit
        target.DISTANCE_WANTED = self.jam_distance
        target.TIME_WANTED = self.headway
        target.POLITENESS = self.politeness
        target.LANE_CHANGE_MIN_ACC_GAIN = self.gain_threshold
        target.LANE_CHANGE_MAX_BRAKING_IMPOSED = self.safe_braking
