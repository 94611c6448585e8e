"""Lane changes in the closed loop, among vehicles put there by hand."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from worlds import FULL, Junction, car

from codriving.datatypes.record import Ending
from codriving.datatypes.world import Action, Kind, Start, WorldState
from codriving.environment.environment import Environment
from codriving.llm.language_model import Offline
from codriving.methods.codriving import CoDriving
from codriving.reasoning.sharing.sharing import CdaLevel

CHANGES = {Action.LANE_LEFT, Action.LANE_RIGHT}
SENSED: dict[str, Any] = {"state_sharing": False, "negotiation": False}
ALONE: dict[str, Any] = {**SENSED, "intent_sharing": False}


def method(world: Junction, **change: Any) -> CoDriving:
    made = CoDriving(CdaLevel(**{**FULL, **change}), Offline(), None, 1.5)
    made.reset(world.road_map, world.model, 0)
    return made


def drive(
    environment: Environment, made: CoDriving, decisions: int = 1000
) -> list[tuple[WorldState, dict[str, Action]]]:
    """Drive for some decisions, or to the end."""
    world, steps = environment.reset(0), []
    while environment.outcome is None and len(steps) < decisions:
        actions = made.act(world).actions
        steps.append((world, actions))
        world = environment.step(actions)
    return steps


@pytest.mark.parametrize("change", [{}, SENSED, ALONE])
def test_a_slow_driver_is_overtaken_whatever_is_shared(change: dict[str, Any], highway: Junction) -> None:
    environment = highway.drive(
        Start("CAV1", Kind.CAV, "lane-1", 100.0, 25.0), Start("HDV1", Kind.HDV, "lane-1", 150.0, 15.0)
    )
    steps = drive(environment, method(highway, **change))
    assert environment.outcome is not None
    assert environment.outcome.ending is Ending.SUCCESS
    assert sum(actions["CAV1"] in CHANGES for _, actions in steps if "CAV1" in actions) in (1, 2)
    assert environment.outcome.arrivals["CAV1"] < 26.0


@pytest.mark.parametrize("change", [{}, SENSED, ALONE])
def test_no_vehicle_changes_onto_a_vehicle_beside_whatever_is_shared(change: dict[str, Any], highway: Junction) -> None:
    slow = car("HDV1", "lane-1", 335.0, 15.0)
    me = car("CAV1", "lane-1", 300.0, 20.0)
    for left, right, expected in ((False, False, CHANGES), (True, False, {Action.LANE_RIGHT}), (True, True, set())):
        cars = [me, slow]
        cars += [car("HDV2", "lane-0", 299.0, 20.0)] if left else []
        cars += [car("HDV3", "lane-2", 302.0, 20.0)] if right else []
        (situation,) = method(highway, **change).act(highway.world(*cars)).situations
        assert CHANGES & set(situation.allowed) == expected


@pytest.mark.parametrize("change", [SENSED, ALONE])
def test_without_state_sharing_lane_changes_go_by_positions_alone(change: dict[str, Any], highway: Junction) -> None:
    world = highway.world(
        car("CAV1", "lane-1", 300.0, 20.0),
        car("CAV2", "lane-0", 310.0, 20.0),
        car("HDV1", "lane-1", 335.0, 15.0),
        car("HDV2", "lane-2", 290.0, 18.0),
    )
    lies = tuple(
        v if v.id == "CAV1" else replace(v, lane=("begin", "end", 3), heading=1.0, acceleration=-5.0, length=9.0)
        for v in world.vehicles
    )
    told, lied = (method(highway, **change).act(w).situations[0] for w in (world, replace(world, vehicles=lies)))
    assert told == lied
    shared = [method(highway).act(w).situations[0] for w in (world, replace(world, vehicles=lies))]
    assert shared[0] != shared[1]


def test_who_finds_no_gap_stops_before_its_lane_ends(configured: Callable[..., Environment]) -> None:
    merge = Junction(configured("scenario=merge", "scenario.lanes=1", "scenario.parallel=60"))
    change = merge.road_map.changes.ahead("ramp", 0.0)
    assert change is not None
    # A queue on the lane beside crawls past, bumper to bumper; no vehicle lets the CAV in.
    queue = [Start(f"HDV{k}", Kind.HDV, "main-0", 205.0 + 7.5 * k, 0.2) for k in range(14)]
    environment = merge.drive(Start("CAV1", Kind.CAV, "ramp", 150.0, 15.0), *queue)
    steps = drive(environment, method(merge), decisions=40)
    assert environment.outcome is None, "no vehicle has been hit"
    world, _ = steps[-1]
    (cav,) = world.cavs
    s, _ = merge.road_map.project("ramp", cav.x, cav.y)
    assert world.intents["CAV1"].route == "ramp"
    assert cav.speed < 0.5
    assert change[1] - 20.0 < s < change[1]


@pytest.mark.parametrize("apart", [-6.0, -2.0, 0.0, 2.0, 6.0])
def test_two_cavs_that_want_the_lane_between_them_do_not_touch(apart: float, highway: Junction) -> None:
    slow = [Start(f"HDV{k}", Kind.HDV, f"lane-{k}", 160.0, 16.0) for k in (0, 2, 3)]
    environment = highway.drive(
        Start("CAV1", Kind.CAV, "lane-0", 120.0, 22.0), Start("CAV2", Kind.CAV, "lane-2", 120.0 + apart, 22.0), *slow
    )
    steps = drive(environment, method(highway))
    assert environment.outcome is not None
    assert environment.outcome.ending is Ending.SUCCESS
    both = [actions for _, actions in steps if set(actions.values()) == CHANGES]
    assert not both
    assert any(CHANGES & set(actions.values()) for _, actions in steps)
