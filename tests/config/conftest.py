"""A user's package of small classes, for tests that build configs."""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import hydra
import pytest

SOURCE = """
from dataclasses import dataclass
from enum import StrEnum
from os import system
from typing import Literal

from codriving.errors import ConfigError, ScenarioError


class Colour(StrEnum):
    RED = "red"
    BLUE = "blue"


class Wheel:
    def __init__(self, radius: float) -> None:
        if radius <= 0:
            raise ValueError(f"radius must be above 0 m, got {radius:g}")
        self.radius = radius


@dataclass(frozen=True, slots=True)
class Car:
    seats: int
    length: float
    electric: bool
    gears: tuple[int, ...]
    size: tuple[float, float]
    colour: Colour
    drive: Literal["front", "rear"]
    wheel: Wheel
    name: str | None
    extras: "list[str]"

    def __post_init__(self) -> None:
        if not 1 <= self.seats <= 9:
            raise ConfigError(f"seats must be 1 to 9, got {self.seats}")
        if self.colour == "blue" and not self.electric:
            raise ConfigError("car.electric=false needs car.colour=red")
        if self.length > 20:
            raise ScenarioError("the car does not fit into the garage")


class Later:
    def __init__(self, gap: int, other: "Unknown") -> None:
        self.gap, self.other = gap, other


def function(x: int) -> int:
    return x
"""


@pytest.fixture(autouse=True)
def _each_config_is_composed(composed_anew: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """Here nothing is composed only once."""
    monkeypatch.setattr(hydra, "compose", composed_anew)


@pytest.fixture
def garage(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """Name of an importable package that is not ours."""
    package = tmp_path / "site" / "garage_of_a_user"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text(SOURCE)
    monkeypatch.syspath_prepend(str(package.parent))
    yield package.name
    sys.modules.pop(package.name, None)
