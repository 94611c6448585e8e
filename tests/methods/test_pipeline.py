"""What a CAV must not know does not change what it decides."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from worlds import Junction, car

from codriving.datatypes.situation import ReasonedDeliberation
from codriving.datatypes.world import Intent, Kind, Start, WorldState
from codriving.methods.codriving import CoDriving

Make = Callable[..., CoDriving]

NO_INTENTS: dict[str, Any] = {"intent_sharing": False, "negotiation": False}


def busy(junction: Junction) -> WorldState:
    """Two CAVs and two human drivers near the junction."""
    return junction.world(
        car("CAV1", "south-north", 86.0, 7.0, 9.0),
        car("CAV2", "west-east", 84.0, 7.0, 9.0),
        car("HDV1", "east-west", 82.0, 7.0),
        car("HDV2", "south-west", 98.0, 5.0),
    )


def told(deliberation: ReasonedDeliberation, ego: str) -> dict[str, Any]:
    (line,) = (cav for cav in deliberation.as_dict()["cavs"] if cav["id"] == ego)
    return {key: value for key, value in line.items() if isinstance(key, str)}


@pytest.mark.parametrize("change", [{}, {"negotiation": False}])
def test_without_state_sharing_headings_lanes_and_accelerations_of_others_are_not_used(
    change: dict[str, Any], method: Make, junction: Junction
) -> None:
    world = busy(junction)
    for ego in ("CAV1", "CAV2"):
        vehicles = tuple(
            v if v.id == ego else replace(v, heading=v.heading + 2.0, acceleration=-4.0, lane=("il2", "o2", 0))
            for v in world.vehicles
        )
        altered = replace(world, vehicles=vehicles)
        hidden = [told(method(state_sharing=False, negotiation=False).act(w), ego) for w in (world, altered)]
        assert hidden[0] == hidden[1]
        shared = [told(method(**change).act(w), ego) for w in (world, altered)]
        assert shared[0] != shared[1], "with state sharing they are known"


def test_without_state_sharing_no_vehicle_far_away_is_known(method: Make, junction: Junction) -> None:
    near = car("CAV1", "south-north", 40.0, 7.0)
    far = [car("CAV2", "north-south", 40.0, 7.0), car("CAV3", "west-north", 50.0, 7.0)]
    alone, among = (
        method(state_sharing=False, negotiation=False).act(junction.world(*c)) for c in ((near,), (near, *far))
    )
    assert told(alone, "CAV1") == told(among, "CAV1")


def test_without_intent_sharing_the_intents_of_other_cavs_are_not_used(method: Make, junction: Junction) -> None:
    world = busy(junction)
    for ego, other in (("CAV1", "CAV2"), ("CAV2", "CAV1")):
        route = {"CAV1": "south-east", "CAV2": "west-south"}[other]
        intents = {**world.intents, other: Intent(route, 0.0, world.intents[other].target_lane)}
        altered = replace(world, intents=intents)
        hidden = [told(method(**NO_INTENTS).act(w), ego) for w in (world, altered)]
        assert hidden[0] == hidden[1]
        shared = [told(method().act(w), ego) for w in (world, altered)]
        assert shared[0] != shared[1], "with intent sharing they are known"


def test_without_intent_sharing_there_are_no_conflicts_and_no_order(method: Make, junction: Junction) -> None:
    for situation in method(**NO_INTENTS).act(busy(junction)).situations:
        assert situation.conflicts == situation.order.precedences == situation.order.sequence == ()
        assert situation.scene.conflict_lanes == ()
        assert all(n.intent is None for n in situation.scene.neighbours)
        assert not any("conflict lane" in reason for a in situation.assessments for reason in a.reasons)


@pytest.mark.parametrize("other", ["CAV2", "HDV1"])
@pytest.mark.parametrize("route", ["west-east", "north-east"])
def test_without_intent_sharing_crossing_traffic_changes_no_decision(
    other: str, route: str, method: Make, junction: Junction
) -> None:
    for mine in (80.0, 92.0, 100.0):
        for theirs in (70.0, 84.0, 98.0):
            me = car("CAV1", "south-north", mine, 8.0)
            alone, among = (
                method(**NO_INTENTS).act(junction.world(*cars)).decisions[0]
                for cars in ((me,), (me, car(other, route, theirs, 8.0)))
            )
            assert alone == among


def test_the_true_route_of_a_human_driver_is_known_to_no_cav(method: Make, junction: Junction) -> None:
    lines = []
    for route in ("west-north", "west-east", "west-south"):
        starts = Start("CAV1", Kind.CAV, "south-north", 80.0, 7.0), Start("HDV1", Kind.HDV, route, 75.0, 7.0)
        environment = junction.drive(*starts)
        world, made = environment.reset(0), method()
        driven = []
        for _ in range(3):
            deliberation = made.act(world)
            driven.append(deliberation.as_dict())
            world = environment.step(deliberation.actions)
        lines.append(driven)
    assert lines[0] == lines[1] == lines[2]


def test_names_say_who_it_is_only_to_those_who_share(method: Make, junction: Junction) -> None:
    sensed = method(state_sharing=False, **NO_INTENTS).act(busy(junction)).situations[0]
    assert {n.kind for n in sensed.scene.neighbours} == {None}
    shared = method().act(busy(junction)).situations[0]
    assert {n.id: n.kind for n in shared.scene.neighbours} == {"CAV2": "CAV", "HDV1": "HDV", "HDV2": "HDV"}


def test_one_decision_for_every_cav_in_order_of_id(method: Make, junction: Junction) -> None:
    world = busy(junction)
    deliberation = method().act(world)
    assert (
        [d.ego for d in deliberation.decisions] == [s.scene.ego.id for s in deliberation.situations] == ["CAV1", "CAV2"]
    )
    for situation, decision in zip(deliberation.situations, deliberation.decisions, strict=True):
        assert decision.action in situation.allowed
        assert tuple(a.action for a in situation.assessments) == world.available[decision.ego]
        assert len(situation.clear_times) == len(situation.conflicts)


def test_a_world_without_cavs_asks_for_nothing(method: Make, junction: Junction) -> None:
    assert method().act(junction.world(car("HDV1", "south-north", 60.0, 7.0))).actions == {}
