"""The careful driver: the fastest action that is free of danger, and the last resort where none is."""

from collections.abc import Callable

import pytest
from seeing import decide
from worlds import Junction, car

from codriving.config.build import build
from codriving.config.training import compose_training
from codriving.datatypes.record import Ending
from codriving.datatypes.world import Action
from codriving.environment.environment import Environment
from codriving.errors import ConfigError
from codriving.methods.single_vehicle.careful import Careful
from codriving.methods.single_vehicle.method import SingleVehicle

CONFIG = compose_training("tell_junction", (), smoke=False)["guidance"]["driver"]


def careful(**change: float) -> Careful:
    """The driver as the trainings have it."""
    made = build({**CONFIG, **change}, object)
    assert isinstance(made, Careful)
    return made


def test_alone_it_goes(junction: Junction) -> None:
    assert decide(careful(), junction, car("CAV1", "south-north", 60.0, 5.0)).action is Action.FASTER


@pytest.mark.parametrize(("gap", "action"), [(40.0, Action.FASTER), (14.0, Action.IDLE), (5.0, Action.SLOWER)])
def test_it_keeps_its_distance(gap: float, action: Action, junction: Junction) -> None:
    ego, ahead = car("CAV1", "south-north", 30.0, 6.0), car("HDV1", "south-north", 35.0 + gap, 6.0)
    choice = decide(careful(), junction, ego, ahead)
    assert choice.action is action
    if action is Action.IDLE:
        assert "too close to HDV1" in choice.refused[Action.FASTER]


def test_it_does_not_drive_to_where_another_vehicle_will_be(junction: Junction) -> None:
    zone = junction.road_map.zones("south-north", "west-east")[0]
    ego = car("CAV1", "south-north", zone.entry_i - 14.0, 7.0, 9.0)
    crosses = car("HDV1", "west-east", zone.entry_j - 12.0, 7.0)
    choice = decide(careful(), junction, ego, crosses)
    assert choice.action is Action.SLOWER
    assert "meets HDV1" in choice.refused[Action.FASTER]
    assert decide(careful(), junction, ego).action is Action.FASTER


def test_who_is_in_the_zone_gets_out_of_it(junction: Junction) -> None:
    zone = junction.road_map.zones("south-north", "west-east")[0]
    ego = car("CAV1", "south-north", zone.entry_i + 3.0, 3.0)
    coming = car("HDV1", "west-east", zone.entry_j - 14.0, 7.0)
    assert decide(careful(), junction, ego, coming).action is Action.FASTER


def test_where_nothing_helps_it_puts_the_danger_off(junction: Junction) -> None:
    ego, ahead = car("CAV1", "south-north", 30.0, 9.0), car("HDV1", "south-north", 37.0, 0.0)
    choice = decide(careful(), junction, ego, ahead)
    assert (choice.action, choice.counts) == (Action.SLOWER, {"cornered": 1})
    assert Action.SLOWER not in choice.refused, "what it does is among what is left"


@pytest.mark.parametrize("scenario", ["intersection", "roundabout"])
def test_it_gets_through(scenario: str, configured: Callable[..., Environment]) -> None:
    environment, method = configured(f"scenario={scenario}"), SingleVehicle(careful())
    world = environment.reset(10_004)
    method.reset(environment.road_map, environment.driving_model, 10_004)
    while environment.outcome is None:
        world = environment.step(method.act(world).actions)
    assert environment.outcome.ending is Ending.SUCCESS


@pytest.mark.parametrize(("key", "value"), [("look", 0.0), ("headway", -1.0), ("standstill", 99.0), ("margin", 9.0)])
def test_settings_out_of_range_are_refused(key: str, value: float) -> None:
    with pytest.raises(ConfigError, match=f"{key} must be"):
        careful(**{key: value})
