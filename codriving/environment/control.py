"""The gains of the paper's proportional controllers, set on highway-env's own (paper Eq. 1)."""

from dataclasses import dataclass

from highway_env.vehicle.controller import ControlledVehicle

from codriving.errors import ConfigError


@dataclass(frozen=True, slots=True)
class ControlGains:
    """How hard a vehicle follows its target speed and lane.

    Attributes:
        speed: K_a in a = K_a (v_r - v) [1/s]; the paper's value is 1.6.
        heading: K_h in delta = arcsin(K_h (phi_r - phi) l / 2v) [1/s]; the paper's value is 5.
        lateral: Gain from the lateral offset to the lateral speed that sets phi_r [1/s]; highway-env's value is 1/0.6.

    Raises:
        ConfigError: If a gain is not positive or makes the controller unstable.
    """

    speed: float
    heading: float
    lateral: float

    def __post_init__(self) -> None:
        for name, value, most in (
            ("speed", self.speed, 5.0),
            ("heading", self.heading, 10.0),
            ("lateral", self.lateral, 5.0),
        ):
            if not 0 < value <= most:
                raise ConfigError(f"control.{name} must be above 0 and at most {most:g} 1/s, got {value:g}")

    def apply(self, vehicle: ControlledVehicle) -> None:
        """Set the gains on one vehicle; its class stays as it is."""
        vehicle.KP_A = self.speed
        vehicle.KP_HEADING = self.heading
        vehicle.KP_LATERAL = self.lateral
