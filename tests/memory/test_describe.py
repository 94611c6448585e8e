"""Descriptions: the same things that a decider is told, and nothing that names a vehicle, a place or a route."""

import re
from dataclasses import replace

import pytest
from worlds import Car, Junction, car, order_of

from codriving.datatypes.order import PassingOrder
from codriving.datatypes.situation import ActionAssessment, Situation
from codriving.datatypes.world import Action
from codriving.memory.describe import brief, describe

MET = (
    car("CAV1", "south-north", 60.0, 8.0),
    car("CAV2", "west-east", 55.0, 7.0),
    car("HDV1", "south-north", 90.0, 6.0),
)


def situation(world: Junction, *cars: Car, order: PassingOrder | None = None) -> Situation:
    thoughts = world.thoughts(*cars)
    conflicts = thoughts.conflicts["CAV1"]
    assessed = tuple(ActionAssessment(a, True, (), (), 50.0) for a in thoughts.available["CAV1"])
    return Situation(
        thoughts.scenes["CAV1"], conflicts, order or PassingOrder((), ()), (0.0,) * len(conflicts), assessed
    )


def test_scene_conflict_and_order_in_words_and_numbers(junction: Junction) -> None:
    told = describe(situation(junction, *MET, order=order_of("CAV2 CAV1")))
    assert told.scene.startswith("Driving 8.0 m/s, target 8.0 m/s; a vehicle 25 m ahead on the lane at 6.0 m/s")
    assert told.conflict.startswith("Crossing conflict with a CAV vehicle")
    assert told.order == "The CAV goes second; 1 go before it."
    assert told.kinds["relation"] == "crossing"
    assert told.kinds["allowed"] == "FASTER IDLE SLOWER"
    assert told.numbers["dttcp"] == pytest.approx(abs(told.numbers["my_ttcp"] - told.numbers["its_ttcp"]), abs=2e-3)
    assert told.numbers["lead_gap"] == pytest.approx(25.0, abs=0.2)


def test_no_vehicle_and_nothing_else_is_named(junction: Junction) -> None:
    text = describe(situation(junction, *MET, order=order_of("CAV2 CAV1"))).text
    assert not re.search(r"CAV\d|HDV\d|south|north|west|east", text)


def test_the_same_situation_elsewhere_reads_the_same(junction: Junction) -> None:
    turned = [replace(c, route={"south-north": "west-east", "west-east": "north-south"}[c.route]) for c in MET]
    here, there = (describe(situation(junction, *cars, order=order_of("CAV2 CAV1"))) for cars in (MET, turned))
    assert here.text == there.text
    assert here.kinds == there.kinds


@pytest.mark.parametrize(
    ("order", "kind", "words"),
    [
        (order_of("CAV1 CAV2"), "first", "The CAV goes first; 0 go before it."),
        (PassingOrder((), ()), "none", "Nothing was agreed."),
    ],
)
def test_the_order_is_part_of_it(order: PassingOrder, kind: str, words: str, junction: Junction) -> None:
    told = describe(situation(junction, *MET, order=order))
    assert (told.kinds["order"], told.order) == (kind, words)


def test_without_conflicts_only_the_scene_is_told(junction: Junction) -> None:
    told = describe(situation(junction, car("CAV1", "south-north", 20.0, 8.0)))
    assert told.conflict == "No conflict."
    assert told.kinds["relation"] == "none"
    assert not {"dttcp", "mine", "lead_gap", "near_ahead"} & set(told.numbers)
    assert brief(told, Action.FASTER) == "At 8.0 m/s, no conflict: FASTER."


def test_lanes_beside_are_told_on_roads_that_have_some(highway: Junction) -> None:
    routes = sorted(highway.road_map.routes)
    told = describe(situation(highway, car("CAV1", routes[0], 100.0, 25.0), car("CAV2", routes[1], 120.0, 20.0)))
    assert "on the right lane a vehicle 15 m ahead at 20.0 m/s" in told.scene
    assert told.numbers["right_ahead"] == pytest.approx(15.0, abs=0.1)


def test_what_is_told_of_it_fits_into_a_prompt(junction: Junction) -> None:
    line = brief(describe(situation(junction, *MET, order=order_of("CAV2 CAV1"))), Action.IDLE)
    assert line.startswith("At 8.0 m/s, crossing with CAV, ")
    assert line.endswith(", second: IDLE.")
    # No word that a prompt would have to explain.
    assert "TTCP" not in line
    assert len(line) < 200
