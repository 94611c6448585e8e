"""Worlds to drive in: the intersection as configured, and small roads with starts by hand."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from typing import Any

import pytest

from codriving.datatypes.limits import VehicleLimits
from codriving.datatypes.parts import Scenario
from codriving.datatypes.road import Road
from codriving.datatypes.world import Scene, Start
from codriving.environment.drivers.style import DriverMix
from codriving.environment.environment import Environment
from codriving.environment.scenarios.intersection import Intersection
from codriving.environment.scenarios.pace import Pace
from codriving.environment.settings import ControlGains, Corrections, DriverProfile
from codriving.environment.traffic.human_driver import HumanDriver

GAINS = ControlGains(speed=1.6, heading=5.0, lateral=1 / 0.6)
DRIVERS: dict[str, float] = {
    "acceleration": 3.0,
    "deceleration": 5.0,
    "limit": 6.0,
    "jam_distance": 10.0,
    "headway": 1.5,
    "sight": 70.0,
    "politeness": 0.0,
    "gain_threshold": 0.2,
    "safe_braking": 2.0,
}
INTERSECTION: dict[str, Any] = {
    "cavs": 4,
    "hdvs": (2, 4),
    "leg_length": 100.0,
    "start": (20.0, 75.0),
    "cav_speed": (5.0, 9.0),
    "hdv_speed": (6.0, 9.0),
    "spacing": 10.0,
    "exit_distance": 25.0,
    "pattern": "random",
    "row_gap": 14.0,
    "turns": ("left", "straight", "right"),
    "blocked_exit": 0.0,
    "blocked_room": 7.0,
    "blind": None,
    "simulation_frequency": 10.0,
    "decision_frequency": 2.0,
    "time_limit": 50.0,
    "target_speeds": (0.0, 3.0, 6.0, 9.0),
    "detection_range": 50.0,
}
SWITCHES = tuple(field.name for field in fields(Corrections))


@dataclass
class ByHand(Scenario):
    """A scenario whose starts are given."""

    built: Road
    pace: Pace
    starts: tuple[Start, ...]
    name: str = "by hand"

    @property
    def road(self) -> Road:
        """The road."""
        return self.built

    def scene(self, seed: int) -> Scene:
        """The starts, whatever the seed."""
        return Scene(seed, self.starts)


def corrections(*off: str) -> Corrections:
    """All corrections but some."""
    return Corrections(**{name: name not in off for name in SWITCHES})


Drive = Callable[..., Environment]


@pytest.fixture
def intersection() -> Drive:
    """Builds an environment at the intersection: switches that are off, then settings of the scenario."""

    def build(*off: str, drivers: dict[str, float] | None = None, **change: Any) -> Environment:
        scenario = Intersection(**{**INTERSECTION, **change})
        return Environment(scenario, GAINS, DriverProfile(**{**DRIVERS, **(drivers or {})}), corrections(*off))

    return build


@pytest.fixture
def by_hand() -> Drive:
    """Builds an environment from a road (default: the intersection) and starts."""

    def build(
        *off: str,
        starts: list[Start],
        road: Road | None = None,
        target_speeds: tuple[float, ...] = (0.0, 3.0, 6.0, 9.0),
        time_limit: float = 30.0,
        drivers: dict[str, float] | None = None,
        limits: VehicleLimits | None = None,
        people: DriverMix | DriverProfile | None = None,
        steady: bool = False,
    ) -> Environment:
        road = road or Intersection(**INTERSECTION).road
        scenario = ByHand(road, Pace(10.0, 2.0, time_limit, target_speeds, 50.0), tuple(starts))
        profile = people or DriverProfile(**{**DRIVERS, **(drivers or {})})
        return Environment(scenario, GAINS, profile, corrections(*off), limits, steady=steady)

    return build


@pytest.fixture
def clean_class() -> Iterator[None]:
    """Undo what `own_parameters=false` leaves behind in the class of drivers, as its fault is."""
    before = dict(vars(HumanDriver))
    yield
    for name in set(vars(HumanDriver)) - set(before):
        delattr(HumanDriver, name)
