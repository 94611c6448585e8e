"""The settings that every scenario shares: frequencies, speeds, time limit, perception."""

from dataclasses import dataclass
from itertools import pairwise

from codriving.errors import require, require_range

TOP_SPEED = 40.0  # No vehicle of highway-env drives faster [m/s]


@dataclass(frozen=True, slots=True)
class Pace:
    """Time, speeds and perception of a scenario.

    Raises:
        ConfigError: If a value is out of range.
    """

    simulation_frequency: float  # Simulation steps per second [Hz]
    decision_frequency: float  # Decisions per second [Hz]
    time_limit: float  # Longest duration of an episode [s]
    target_speeds: tuple[float, ...]  # Speeds that FASTER and SLOWER step through [m/s]
    detection_range: float  # Radius of perception [m]

    def __post_init__(self) -> None:
        require_range("simulation_frequency", self.simulation_frequency, 5, 50, " Hz")
        require_range("decision_frequency", self.decision_frequency, 0.5, 5, " Hz")
        require_range("time_limit", self.time_limit, 1, 600, " s")
        require_range("detection_range", self.detection_range, 5, 500, " m")
        ratio = self.simulation_frequency / self.decision_frequency
        require(
            abs(ratio - round(ratio)) < 1e-9,
            f"simulation_frequency must be a multiple of decision_frequency ({self.decision_frequency:g} Hz), "
            f"got {self.simulation_frequency:g} Hz",
        )
        speeds = self.target_speeds
        gaps = [b - a for a, b in pairwise(speeds)]
        within = len(speeds) >= 2 and speeds[0] >= 0 and speeds[-1] <= TOP_SPEED
        require(
            within and min(gaps) > 0 and max(gaps) - min(gaps) < 1e-9,
            f"target_speeds must be two or more evenly spaced, rising speeds within 0 to {TOP_SPEED:g} m/s "
            f"(highway-env's actions assume it), got {list(speeds)}",
        )
