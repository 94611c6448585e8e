"""What one CAV sees alone in a world made by hand, and the drivers of the configuration."""

from functools import lru_cache
from typing import Any, TypeVar

from worlds import Car, Junction

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.methods.noncoop_game.noncoop_game import NonCooperativeGame
from codriving.methods.pidm import ProjectedIdm
from codriving.methods.single_vehicle.alone import Alone
from codriving.methods.single_vehicle.protocol import Choice, Driver, View
from codriving.reasoning.perception import single_vehicle_perception

D = TypeVar("D", bound=Driver)


def seen(junction: Junction, *cars: Car, ego: str = "CAV1", time: float = 0.0) -> View:
    """The view of one CAV."""
    return views(junction, [cars], ego, time)[-1]


def views(junction: Junction, moments: list[tuple[Car, ...]], ego: str = "CAV1", start: float = 0.0) -> list[View]:
    """Its views one decision after another."""
    perception = single_vehicle_perception(junction.road_map, junction.forecast())
    found = []
    for k, cars in enumerate(moments):
        world = junction.world(*cars, time=start + k * junction.model.decision_interval, step=k)
        told = perception.perceive(world)
        found.append(
            View(
                told.scenes[ego],
                told.conflicts[ego],
                world.available[ego],
                junction.road_map,
                perception.forecast,
                world.time,
            )
        )
    return found


@lru_cache
def config(name: str, *overrides: str) -> dict[str, Any]:
    """The config of a method; composing takes long."""
    method: dict[str, Any] = compose([f"method={name}", *overrides])["method"]
    return method


def configured(name: str, kind: type[D], *overrides: str) -> D:
    """The driver of a method as it is configured, at the beginning of an episode."""
    made = build(config(name, *overrides))
    assert isinstance(made, Alone)
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
    return driver.decide(seen(junction, *cars, ego=ego))
