"""How early a CAV can be at each place of its route, and how long it takes at least from one to another."""

from dataclasses import dataclass, field

import numpy as np

from codriving.bound.envelope import BIN, Envelope
from codriving.datatypes import Route, Start
from codriving.errors import ScenarioError
from codriving.geometry import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Passing:
    """What is known of the times at which one CAV passes the places of its route."""

    start: Start
    route: Route
    alone: FloatArray  # Arc length at each step of the drive that is FASTER for ever (n,) [m]
    envelope: Envelope
    step: float  # [s]
    top_speed: float  # [m/s]
    _elapsed: FloatArray = field(init=False, repr=False)

    def __post_init__(self) -> None:
        if self.alone[-1] < self.route.goal:
            raise ScenarioError(
                f"{self.start.id} does not arrive within the time limit even if it is alone on the road"
            )
        object.__setattr__(
            self, "_elapsed", np.concatenate(([0.0], np.cumsum(BIN / (self.envelope.pace * self._faster))))
        )

    @property
    def arrival(self) -> float:
        """When it arrives if it drives alone [s]; the environment looks once a step."""
        return round((len(self.alone) - 1) * self.step, 9)

    @property
    def least_arrival(self) -> float:
        """When it arrives at the earliest [s]: the time alone, unless that is missed by less than the lead."""
        ticks = np.ceil((float(self.earliest(np.array([self.route.goal]))[0]) - 1e-9) / self.step)
        return round(float(ticks) * self.step, 9)

    @property
    def fastest(self) -> float:
        """Highest progress along the route at any place [m/s]."""
        return float(self.envelope.pace.max()) * self._faster

    @property
    def _faster(self) -> float:
        # A CAV that starts faster than its highest target only slows down.
        return max(1.0, self.start.speed / self.top_speed)

    def least_time(self, places: FloatArray) -> FloatArray:
        """Return how long it takes at least from the start of the route to places [m], at its highest pace [s]."""
        return np.asarray(np.interp(places, BIN * np.arange(len(self._elapsed)), self._elapsed))

    def earliest(self, places: FloatArray) -> FloatArray:
        """Return when it can be at places [m] at the earliest [s]."""
        here = self.start.position
        alone = times_at(self.alone, places, self.step) - self.envelope.lead
        return np.asarray(np.maximum(np.maximum(alone, self.least_time(places) - self.least_time(np.array(here))), 0.0))


def times_at(drive: FloatArray, places: FloatArray, step: float) -> FloatArray:
    """Return when a drive (n,) [m] is at places [m]; steps that take 1 are counted, with parts of them."""
    rising = np.maximum.accumulate(drive) + 1e-9 * np.arange(len(drive))
    return np.asarray(np.interp(places, rising, step * np.arange(len(drive))))
