"""What one CAV sees alone in a world made by hand, and the drivers of the configuration."""

from functools import lru_cache
from typing import Any, TypeVar

from worlds import Car, Junction

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.methods.noncoop_game.noncoop_game import NonCooperativeGame
from codriving.methods.pidm import ProjectedIdm
from codriving.methods.single_vehicle.method import Choice, Driver, SingleVehicle
from codriving.reasoning.perception import Moment, single_vehicle_perception

D = TypeVar("D", bound=Driver)

Seen = tuple[Moment, str]


def seen(junction: Junction, *cars: Car, ego: str = "CAV1", time: float = 0.0) -> Seen:
    """One moment, and the CAV that sees it."""
    return seen_each(junction, [cars], ego, time)[-1]


def seen_each(junction: Junction, moments: list[tuple[Car, ...]], ego: str = "CAV1", start: float = 0.0) -> list[Seen]:
    """One decision after another, and the CAV that sees them."""
    perception = single_vehicle_perception(junction.road_map, junction.forecast())
    step = junction.model.decision_interval
    return [
        (perception.perceive(junction.world(*cars, time=start + k * step, step=k)), ego)
        for k, cars in enumerate(moments)
    ]


@lru_cache
def config(name: str, *overrides: str) -> dict[str, Any]:
    """The config of a method; composing takes long."""
    method: dict[str, Any] = compose([f"method={name}", *overrides])["method"]
    return method


def configured(name: str, kind: type[D], *overrides: str) -> D:
    """The driver of a method as it is configured, at the beginning of an episode."""
    made = build(config(name, *overrides), object)
    assert isinstance(made, SingleVehicle)
    assert isinstance(made.driver, kind)
    made.driver.reset()
    return made.driver


def pidm(*overrides: str) -> ProjectedIdm:
    """Projected IDM."""
    return configured("pidm", ProjectedIdm, *overrides)


def game(*overrides: str) -> NonCooperativeGame:
    """The non-cooperative game."""
    return configured("noncoop_game", NonCooperativeGame, *overrides)


def decide(driver: Driver, junction: Junction, *cars: Car, ego: str = "CAV1") -> Choice:
    """What a driver does at one moment."""
    return driver.decide(*seen(junction, *cars, ego=ego))
