"""Drivers of one style, whose values are all fixed, and what they do at the intersection."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from drivers_at_work import Crossing

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.parts import Drivers
from codriving.datatypes.world import Kind, Start
from codriving.environment.drivers.style import DriverMix
from codriving.environment.environment import Environment

Build = Callable[..., Environment]

MIDDLE = {
    "headway": (1.4, 1.4),
    "acceleration": (2.0, 2.0),
    "deceleration": (3.0, 3.0),
    "speed": (1.0, 1.0),
    "reaction": (0.8, 0.8),
    "patience": (8.0, 8.0),
}


@pytest.fixture
def people() -> Callable[..., DriverMix]:
    """Gives a mix of one style as it is configured, but for the values that vary among drivers of a style."""
    made: Any = build(compose(["drivers=mixed"])["drivers"], Drivers, "drivers")

    def choose(style: str, signals: float = 1.0, **change: Any) -> DriverMix:
        fixed = replace(made.styles[style], **{**MIDDLE, **change})
        return replace(made, shares={style: 1.0}, styles={style: fixed}, signals=signals)

    return choose


@pytest.fixture
def cross(by_hand: Build) -> Callable[..., Crossing]:
    """Drives some vehicles, each with route, place and speed, with human drivers as they are given."""

    def drive(
        drivers: Drivers, hold: Callable[[Environment], None] | None = None, **vehicles: tuple[str, float, float]
    ) -> Crossing:
        starts = [
            Start(name, Kind.CAV if name.startswith("CAV") else Kind.HDV, *where) for name, where in vehicles.items()
        ]
        return Crossing(by_hand(starts=starts, people=drivers), hold)

    return drive
