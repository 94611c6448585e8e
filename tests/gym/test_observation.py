"""What stands in an observation, and what each CDA level hides from it."""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from math import cos, hypot, sin
from typing import Any

import numpy as np
import pytest
from worlds import FULL, Car, Junction, car

from codriving.datatypes.world import WorldState
from codriving.errors import ConfigError
from codriving.gym.observation import FEATURES, CdaObserver, FloatArray, Layout
from codriving.reasoning.sharing.sharing import CdaLevel

X, Y, VX, VY, LANE, INTENTION = range(6)
LEFT, STRAIGHT, RIGHT = 1, 2, 3

See = Callable[..., dict[str, FloatArray]]


@pytest.fixture
def see(junction: Junction) -> See:
    """Shows a world to its CAVs; settings are toggles of the CDA level or of the layout."""

    def show(world: WorldState, **settings: Any) -> dict[str, FloatArray]:
        level = CdaLevel(**{key: settings.pop(key, value) for key, value in FULL.items()})
        layout = Layout(**{"coordinates": "absolute", **settings})
        observer = CdaObserver(junction.road_map, junction.model, level, layout)
        seen = observer.observe(world)
        assert all(observer.space().contains(matrix) for matrix in seen.values())
        return seen

    return show


def cars() -> tuple[Car, ...]:
    return (
        car("CAV1", "south-west", 20.0, 7.0),
        car("CAV2", "north-east", 20.0, 8.0),
        car("HDV1", "north-west", 60.0, 6.0),
        car("HDV2", "west-north", 60.0, 5.0),
    )


def test_columns_are_those_of_the_paper() -> None:
    assert FEATURES == ("x", "y", "vx", "vy", "lane", "intention")


def test_ego_comes_first_then_the_others_by_distance_then_zeros(junction: Junction, see: See) -> None:
    world = junction.world(*cars())
    matrix = see(world, rows=6)["CAV1"]
    ego = world.vehicles[0]
    assert matrix.shape == (6, 6)
    assert matrix.dtype == np.float32
    assert matrix[0, :2] == pytest.approx((ego.x, ego.y))
    far = [hypot(x - ego.x, y - ego.y) for x, y in matrix[:3, :2]]
    assert all(a < b for a, b in pairwise(far))
    assert not matrix[3:].any(), "HDV2 is out of range of every CAV, so there are three rows"


def test_few_rows_keep_the_nearest(junction: Junction, see: See) -> None:
    world = junction.world(*cars())
    np.testing.assert_array_equal(see(world, rows=2)["CAV1"], see(world, rows=8)["CAV1"][:2])
    assert see(world, rows=1)["CAV1"].shape == (1, 6)


def test_velocity_is_over_ground(junction: Junction, see: See) -> None:
    world = junction.world(car("CAV1", "south-west", 110.0, 7.0))
    ego = world.vehicles[0]
    row = see(world)["CAV1"][0]
    assert row[[VX, VY]] == pytest.approx((7 * cos(ego.heading), 7 * sin(ego.heading)), abs=1e-5)
    assert min(abs(row[VX]), abs(row[VY])) > 0.5, "in the middle of a turn"


def test_relative_places_are_seen_from_the_ego_vehicle(junction: Junction, see: See) -> None:
    world = junction.world(*cars())
    absolute, relative = (see(world, coordinates=kind)["CAV1"] for kind in ("absolute", "relative"))
    np.testing.assert_array_equal(relative[0], absolute[0])
    np.testing.assert_allclose(relative[1:3, :2], absolute[1:3, :2] - absolute[0, :2], rtol=1e-5)
    np.testing.assert_array_equal(relative[:, 2:], absolute[:, 2:])
    assert not relative[3:].any(), "no vehicle is not a vehicle far away"


@pytest.mark.parametrize("coordinates", ["absolute", "relative"])
def test_normalised_is_within_one_and_the_same_otherwise(junction: Junction, see: See, coordinates: str) -> None:
    world = junction.world(*cars())
    plain, scaled = (see(world, coordinates=coordinates, normalise=flag)["CAV1"] for flag in (False, True))
    assert np.abs(scaled).max() <= 1
    low, high = Layout(8, coordinates).bounds(junction.road_map)
    np.testing.assert_allclose(scaled * np.maximum(-low, high), plain, rtol=1e-5, atol=1e-5)


def test_full_shows_lane_and_intention_of_cavs_and_only_the_lane_of_hdvs(junction: Junction, see: See) -> None:
    rows = see(junction.world(*cars()))["CAV2"]
    assert rows[:3, INTENTION].tolist() == [LEFT, 0, LEFT], "itself, HDV1, CAV1"
    assert (rows[:3, LANE] >= 1).all()


def test_own_row_hides_nothing(junction: Junction, see: See) -> None:
    world = junction.world(*cars())
    full, least = see(world), see(world, state_sharing=False, intent_sharing=False, negotiation=False)
    for name, matrix in full.items():
        np.testing.assert_array_equal(least[name][0], matrix[0])


def test_without_intent_sharing_no_intention_of_others(junction: Junction, see: See) -> None:
    world = junction.world(*cars())
    full, without = see(world), see(world, intent_sharing=False, negotiation=False)
    for name, matrix in without.items():
        assert not matrix[1:, INTENTION].any()
        np.testing.assert_array_equal(matrix[:, :INTENTION], full[name][:, :INTENTION])


def test_without_state_sharing_only_place_and_speed_within_range(junction: Junction, see: See) -> None:
    world = junction.world(*cars())
    seen = see(world, state_sharing=False)
    assert not seen["CAV1"][1:].any(), "no vehicle within 50 m"
    hdv = next(v for v in world.vehicles if v.id == "HDV1")
    np.testing.assert_allclose(seen["CAV2"][1], (hdv.x, hdv.y, hdv.speed, 0, 0, 0), rtol=1e-5)
    assert not seen["CAV2"][2:].any()


def test_a_shared_intent_is_known_of_whom_one_senses(junction: Junction, see: See) -> None:
    world = junction.world(car("CAV1", "south-west", 20.0, 7.0), car("CAV2", "south-east", 40.0, 7.0))
    row = see(world, state_sharing=False)["CAV1"][1]
    assert row[[VX, VY, LANE, INTENTION]] == pytest.approx((7, 0, 0, RIGHT))


def test_hidden_things_make_no_difference(junction: Junction, see: See) -> None:
    """Whatever a level hides, an observation is the same for every value of it."""
    one = junction.world(car("CAV1", "south-west", 20.0, 7.0), car("CAV2", "south-east", 40.0, 7.0, target=9.0))
    first, second = one.vehicles
    turned = replace(second, heading=second.heading + 1, lane=("ir0", "il3", 0), acceleration=2.0, kind="HDV")
    bound = {**one.intents, "CAV2": replace(one.intents["CAV2"], route="south-north", target_speed=3.0)}
    other = replace(one, vehicles=(first, turned), intents=bound)
    least = {"state_sharing": False, "intent_sharing": False, "negotiation": False}
    np.testing.assert_array_equal(see(other, **least)["CAV1"], see(one, **least)["CAV1"])
    assert (see(other)["CAV1"] != see(one)["CAV1"]).any()


def test_real_rows_are_never_zeros(junction: Junction, see: See) -> None:
    world = junction.world(car("CAV1", "south-west", 20.0, 0.0), car("CAV2", "south-east", 40.0, 0.0))
    for coordinates in ("absolute", "relative"):
        matrix = see(world, state_sharing=False, intent_sharing=False, negotiation=False, coordinates=coordinates)
        assert matrix["CAV1"][:2].any(axis=1).all()


def test_who_is_off_the_map_is_held_at_its_edge(junction: Junction, see: See) -> None:
    world = junction.world(*cars())
    lost = tuple(replace(v, x=1e4) if v.id == "CAV2" else v for v in world.vehicles)
    matrix = see(replace(world, vehicles=lost))["CAV2"]
    assert matrix[0, X] == Layout().bounds(junction.road_map)[1][0, X]


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"rows": 0}, "rows must be a whole number from 1 to 100, got 0"),
        ({"rows": 2.0}, "got 2.0"),
        ({"rows": True}, "got True"),
        ({"coordinates": "polar"}, "coordinates must be relative or absolute, got 'polar'"),
        ({"normalise": 1}, "normalise must be True or False, got 1"),
    ],
)
def test_wrong_layouts_are_refused(settings: dict[str, Any], said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        Layout(**settings)
