"""Settings of the environment: control gains, human drivers, and which faults of highway-env 1.12 are corrected."""

from dataclasses import dataclass

from highway_env.vehicle.behavior import IDMVehicle
from highway_env.vehicle.controller import ControlledVehicle

from codriving.datatypes import Drivers
from codriving.errors import require, require_range


@dataclass(frozen=True, slots=True)
class ControlGains:
    """How hard a vehicle follows its target speed and lane."""

    speed: float  # K_a in a = K_a (v_r - v) [1/s]; the paper's value is 1.6
    heading: float  # K_h in delta = arcsin(K_h (phi_r - phi) l / 2v) [1/s]; the paper's value is 5
    # Gain from the lateral offset to the lateral speed that sets phi_r [1/s]; highway-env's value is 1/0.6.
    lateral: float

    def __post_init__(self) -> None:
        for name, most in (("speed", 5), ("heading", 10), ("lateral", 5)):
            value = getattr(self, name)
            require(0 < value <= most, f"control.{name} must be above 0 and at most {most} 1/s, got {value:g}")

    def apply(self, vehicle: ControlledVehicle) -> None:
        """Set the gains on one vehicle; its class stays as it is."""
        vehicle.KP_A, vehicle.KP_HEADING, vehicle.KP_LATERAL = self.speed, self.heading, self.lateral


@dataclass(frozen=True, slots=True)
class Corrections:
    """One switch for every fault; all on in ``conf/config.yaml``.

    With every switch off a vehicle moves as highway-env's own classes do, bit for bit.
    """

    no_reverse: bool
    route_prediction: bool
    route_leader: bool
    route_lane: bool
    yield_at_entry: bool
    start_into_gap: bool
    connected_lanes: bool
    # highway-env's intersection writes driver parameters into the class, for every later scenario of the process. On:
    # they belong to the driver.
    own_parameters: bool
    remove_at_sink: bool
    true_collisions: bool


@dataclass(frozen=True, slots=True)
class DriverProfile(Drivers):
    """Parameters of the Intelligent Driver Model and of MOBIL."""

    acceleration: float  # IDM's comfortable acceleration a [m/s2]
    deceleration: float  # IDM's comfortable deceleration b [m/s2]
    limit: float  # Hardest acceleration or braking that a driver can do [m/s2]
    jam_distance: float  # Distance between the centres of two standing cars [m]
    headway: float  # Desired time gap [s]
    sight: float  # How far ahead along the route a driver looks for bodies [m]
    politeness: float
    gain_threshold: float  # MOBIL's smallest gain for a lane change [m/s2]
    safe_braking: float  # MOBIL's hardest braking imposed on the new follower [m/s2]

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
            require_range(f"drivers.{name}", getattr(self, name), low, high)

    def apply(self, driver: IDMVehicle, to_class: bool) -> None:
        """Set the parameters."""
        target = type(driver) if to_class else driver
        target.COMFORT_ACC_MAX, target.COMFORT_ACC_MIN = self.acceleration, -self.deceleration
        target.ACC_MAX, target.POLITENESS = self.limit, self.politeness
        target.DISTANCE_WANTED, target.TIME_WANTED = self.jam_distance, self.headway
        target.LANE_CHANGE_MIN_ACC_GAIN = self.gain_threshold
        target.LANE_CHANGE_MAX_BRAKING_IMPOSED = self.safe_braking
