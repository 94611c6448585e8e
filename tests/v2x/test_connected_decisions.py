"""A message about a vehicle changes a decision, and its loss changes that back."""

import math

import pytest
from driven import ordered
from hearing import FLAWLESS
from worlds import FULL, Car, Junction, car

from codriving.datatypes.parts import Method, RuleModel
from codriving.datatypes.world import Action, WorldState
from codriving.methods.codriving import CoDriving
from codriving.methods.fcfs import FirstComeFirstServed
from codriving.reasoning.sharing.sharing import CdaLevel
from codriving.v2x.connected import V2X
from codriving.v2x.draws import Link

EGO = car("CAV1", "south-north", 92.0, 6.0)
HUMAN = car("HDV1", "west-east", 95.0, 6.0)
WITNESS = car("CAV2", "west-east", 75.0, 6.0)
HIDDEN = (("CAV1", "CAV2"), ("CAV1", "HDV1"))
"""Buildings stand between CAV1 and all that come from the west."""


def decided(junction: Junction, method: Method, *cars: Car) -> dict[str, Action]:
    """What is decided half a second after a first step, on which all was sent."""
    method = V2X(**{**FLAWLESS, "age": 0.3}).between(method, [])
    method.reset(junction.road_map, junction.model, 5)
    actions: dict[str, Action] = {}
    for time in (0.0, 0.5):
        w = junction.world(*cars, time=time, step=round(2 * time))
        actions = method.act(WorldState(time, w.step, w.vehicles, w.intents, w.available, {}, HIDDEN)).actions
    return actions


def methods(junction: Junction) -> dict[str, Method]:
    """Two that decide by what is shared, one of them an ordering rule."""
    return {
        "codriving": CoDriving(CdaLevel(**FULL), RuleModel(), None, 1.5),
        "fcfs": ordered(junction, FirstComeFirstServed()),
    }


@pytest.mark.parametrize("name", ["codriving", "fcfs"])
def test_it_brakes_for_a_vehicle_that_it_has_only_heard_of(
    name: str, junction: Junction, monkeypatch: pytest.MonkeyPatch
) -> None:
    cars = (EGO, HUMAN, WITNESS)
    assert decided(junction, methods(junction)[name], *cars)["CAV1"] is Action.SLOWER
    monkeypatch.setattr(Link, "delay", lambda self, tick: math.inf)
    lost = decided(junction, methods(junction)[name], *cars)["CAV1"]
    assert lost is decided(junction, methods(junction)[name], EGO)["CAV1"] is Action.FASTER


def test_of_two_cavs_that_cannot_see_each_other_one_gives_way_if_they_hear_of_each_other(
    junction: Junction, monkeypatch: pytest.MonkeyPatch
) -> None:
    cars = (car("CAV1", "south-north", 90.0, 8.0), car("CAV2", "west-east", 94.0, 8.0))
    heard = decided(junction, methods(junction)["codriving"], *cars)
    assert Action.SLOWER in heard.values()
    monkeypatch.setattr(Link, "delay", lambda self, tick: math.inf)
    assert set(decided(junction, methods(junction)["codriving"], *cars).values()) == {Action.FASTER}
