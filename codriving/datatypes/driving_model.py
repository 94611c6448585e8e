"""How a CAV answers to semantic actions: the numbers that a prediction needs."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class DrivingModel:
    """The vehicle model seen through the five actions (paper Eq. 1)."""

    target_speeds: tuple[float, ...]  # Allowed target speeds, uniformly spaced and rising [m/s]
    speed_gain: float  # Proportional gain K_a of the speed law a = K_a (v_r - v) [1/s]
    step: float  # Simulation step [s]
    decision_interval: float  # Time between two decisions, a multiple of the step [s]
    detection_range: float  # Radius within which a CAV perceives other vehicles [m]

    @property
    def top_speed(self) -> float:
        """Highest target speed [m/s]."""
        return self.target_speeds[-1]

    @property
    def substeps(self) -> int:
        """Simulation steps per decision."""
        return round(self.decision_interval / self.step)
