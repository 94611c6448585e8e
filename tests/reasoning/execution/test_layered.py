"""The reference executor: the first group accelerates, all others wait for their turn."""

from dataclasses import replace
from typing import Any

import pytest
from driven import layered, moment_of, ordering_of
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import Car, Junction, car

from codriving.datatypes.world import Action
from codriving.errors import ConfigError
from codriving.geometry.box import TRUE
from codriving.reasoning.execution.layered import layers_of
from codriving.reasoning.execution.planned import Drive

ROUTES = tuple(
    f"{a}-{b}" for a in ("south", "west", "north", "east") for b in ("south", "west", "north", "east") if a != b
)
FOUR = ("south-north", "north-south", "west-east", "east-west")


def four(place: float = 85.0, speed: float = 6.0) -> list[Car]:
    """Two that go north and south, and two that go east and west, a leg each."""
    return [car(f"CAV{k}", route, place, speed) for k, route in enumerate(FOUR, 1)]


def act(junction: Junction, cars: list[Car], *order: str, **change: Any) -> Drive:
    return layered(**change).drive(moment_of(junction.thoughts(*cars)), ordering_of(*order))


def test_those_whose_ways_do_not_meet_share_a_layer(junction: Junction) -> None:
    moment = moment_of(junction.thoughts(*four()))
    assert layers_of(moment, ordering_of("CAV1", "CAV2", "CAV3", "CAV4")) == {
        "CAV1": 0,
        "CAV2": 0,
        "CAV3": 1,
        "CAV4": 1,
    }
    assert layers_of(moment, ordering_of("CAV1", "CAV3", "CAV2", "CAV4")) == {
        "CAV1": 0,
        "CAV3": 1,
        "CAV2": 2,
        "CAV4": 3,
    }


@settings(max_examples=30, deadline=None)
@given(
    st.lists(st.tuples(st.sampled_from(ROUTES), st.floats(20.0, 95.0)), min_size=1, max_size=7),
    st.randoms(use_true_random=False),
)
def test_a_layer_is_one_more_than_the_highest_it_has_to_wait_for(
    junction: Junction, some: list[tuple[str, float]], draw: Any
) -> None:
    moment = moment_of(junction.thoughts(*[car(f"CAV{k}", *c, 6.0) for k, c in enumerate(some)]))
    order = sorted(name for name, cs in moment.conflicts.items() if cs)
    draw.shuffle(order)
    layers = layers_of(moment, ordering_of(*order))
    assert list(layers) == order
    for k, name in enumerate(order):
        earlier = {other: layers[other] for other in order[:k] if other in {c.other for c in moment.conflicts[name]}}
        assert all(layer < layers[name] for layer in earlier.values())
        assert layers[name] == 0 or layers[name] - 1 in earlier.values(), "and not later than needed"


def test_the_first_layer_goes_and_the_others_hold(junction: Junction) -> None:
    drive = act(junction, four(), "CAV3", "CAV4", "CAV1", "CAV2")
    assert {n: a for n, a in drive.actions.items() if a is Action.FASTER}.keys() == {"CAV3", "CAV4"}
    assert drive.actions["CAV1"] is drive.actions["CAV2"] is Action.SLOWER
    assert drive.counts == {"layers": 1}
    assert "first group" in drive.reasons["CAV3"]
    assert "layer 0" in drive.reasons["CAV1"]


@pytest.mark.parametrize(
    ("anywhere", "away", "action"),
    [
        (False, 29.0, Action.SLOWER),
        (False, 31.0, Action.IDLE),
        (True, 31.0, Action.SLOWER),
        (True, 80.0, Action.SLOWER),
    ],
)
def test_a_vehicle_that_waits_slows_down_near_the_zone_or_wherever_it_is(
    anywhere: bool, away: float, action: Action, junction: Junction
) -> None:
    (zone,) = junction.road_map.zones("west-east", "south-north")
    cars = [car("CAV1", "south-north", 85.0, 6.0), car("CAV2", "west-east", zone.entry_i - away, 6.0)]
    drive = act(junction, cars, "CAV1", "CAV2", brake_anywhere=anywhere)
    assert drive.actions == {"CAV1": Action.FASTER, "CAV2": action}


def test_no_vehicle_enters_a_zone_that_is_taken(junction: Junction) -> None:
    (zone,) = junction.road_map.zones("south-north", "west-east", TRUE)
    inside = car("CAV2", "west-east", (zone.entry_j + zone.exit_j) / 2, 3.0)
    drive = act(junction, [car("CAV1", "south-north", 90.0, 6.0), inside], "CAV1", "CAV2")
    assert drive.actions["CAV1"] is Action.SLOWER
    assert "CAV2" in drive.reasons["CAV1"]


@pytest.mark.parametrize(("gap", "action"), [(6.0, Action.SLOWER), (7.5, Action.IDLE), (14.0, Action.FASTER)])
def test_no_vehicle_comes_too_close_to_the_one_ahead(gap: float, action: Action, junction: Junction) -> None:
    # 0.9 s at 6 m/s, and a metre: 6.4 m between the bodies. A little farther away it neither slows down nor speeds up.
    cars = [car("CAV1", "south-north", 40.0, 6.0), car("CAV2", "south-north", 45.0 + gap, 6.0)]
    drive = act(junction, cars)
    assert drive.actions == {"CAV1": action, "CAV2": Action.FASTER}


def test_a_driver_who_may_be_there_first_is_waited_for(junction: Junction) -> None:
    cars = [car("CAV1", "south-north", 85.0, 6.0), car("HDV1", "west-east", 85.0, 6.0)]
    moment = moment_of(junction.thoughts(*cars))
    waits, goes = (layered().drive(moment, ordering_of("CAV1", CAV1=time)) for time in (3.0, -5.0))
    assert waits.actions["CAV1"] is Action.SLOWER
    assert "HDV1" in waits.reasons["CAV1"]
    assert goes.actions["CAV1"] is Action.FASTER, "it would be through before"


@pytest.mark.parametrize(("key", "value"), [("gap", -1.0), ("hold", 201.0), ("headway", 6.0)])
def test_settings_out_of_range_are_refused(key: str, value: float) -> None:
    with pytest.raises(ConfigError, match=f"{key} must be 0 to"):
        layered(**{key: value})


@pytest.mark.parametrize(("later", "action"), [(0.08, Action.FASTER), (0.12, Action.SLOWER)])
def test_a_difference_of_a_tenth_of_a_second_is_not_waited_for(
    later: float, action: Action, junction: Junction
) -> None:
    moment = moment_of(junction.thoughts(*four()))
    ordering = ordering_of("CAV1", "CAV2", "CAV3", "CAV4")
    # CAV1 is 19.4 m before the crossing and can be there in 2.36 s.
    held = replace(ordering, not_before={"CAV1": 2.36 + later})
    assert layered().drive(moment, held).actions["CAV1"] is action
