"""The fuzzy coalition: joint actions at the intersection."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from coalitions import Scheduled, instance, vehicle
from worlds import Car, Junction, car

from codriving.datatypes.world import Action
from codriving.errors import ConfigError
from codriving.methods.coop_game_fuzzy.coop_game_fuzzy import LIBRARY, OPTIONS, Arrival, CoopGameFuzzy
from codriving.reasoning.execution.planned import Executor
from codriving.reasoning.ordering.protocol import Ordering, Request
from codriving.reasoning.perception import Moment
from codriving.reasoning.prediction.forecast import Forecast

ORDER = Ordering((), {})

SETTINGS: dict[str, Any] = {
    "gap": 0.6,
    "participation": 0.7,
    "risk": 0.6,
    "efficiency": 0.3,
    "comfort": 0.1,
    "reference_acceleration": 4.0,
    "hold": 2.0,
    "horizon": 5.0,
    "shares": False,
    "control_radius": 60.0,
}


def coalition(**change: Any) -> Executor:
    return CoopGameFuzzy(**{**SETTINGS, **change}).executor


def moment(junction: Junction, *cars: Car) -> Moment:
    world = junction.world(*cars)
    thoughts = junction.think(world)
    forecast = Forecast(junction.model, LIBRARY)
    forecast.begin_step([(c.speed, world.intents[c.id].target_speed, "", 0.0) for c in world.cavs])
    return replace(thoughts.moment(), forecast=forecast)


def routes(junction: Junction) -> tuple[str, str]:
    """Two routes that cross, straight on both."""
    found = sorted(r for r in junction.road_map.routes if junction.road_map.routes[r].turn.name == "STRAIGHT")
    return next((a, b) for a in found for b in found if a != b and junction.road_map.zones(a, b))


def entry(junction: Junction, one: str, other: str) -> float:
    return junction.road_map.zones(one, other)[0].entry_i


def test_a_vehicle_that_is_alone_goes(junction: Junction) -> None:
    route, _ = routes(junction)
    drive = coalition().drive(moment(junction, car("CAV1", route, 20.0, 4.0)), ORDER)
    assert drive.actions == {"CAV1": Action.FASTER}
    assert list(drive.progress["CAV1"]) == list(OPTIONS)
    assert drive.progress["CAV1"][Action.FASTER] > drive.progress["CAV1"][Action.SLOWER]


@pytest.mark.parametrize("participation", [0.0, 0.7, 1.0])
def test_of_two_who_would_meet_one_gives_way(junction: Junction, participation: float) -> None:
    one, other = routes(junction)
    cars = [car("CAV1", a, entry(junction, a, b) - 22.0, 8.0) for a, b in ((one, other),)]
    cars.append(car("CAV2", other, entry(junction, other, one) - 24.0, 8.0))
    drive = coalition(participation=participation).drive(moment(junction, *cars), ORDER)
    assert len(set(drive.actions.values())) == 2
    assert list(drive.expected) == ["CAV1", "CAV2"]
    (first,), (second,) = drive.expected["CAV1"], drive.expected["CAV2"]
    path = junction.road_map.paths
    apart = np.hypot(*(np.subtract(path[one].position(first.places), path[other].position(second.places))))
    assert apart.min() > 4.0


def test_risk_without_weight_lets_every_vehicle_go(junction: Junction) -> None:
    one, other = routes(junction)
    cars = (
        car("CAV1", one, entry(junction, one, other) - 15.0, 6.0),
        car("CAV2", other, entry(junction, other, one) - 15.0, 6.0),
    )
    drive = coalition(risk=0.0).drive(moment(junction, *cars), ORDER)
    assert set(drive.actions.values()) == {Action.FASTER}


def test_a_human_driver_is_given_way_to(junction: Junction) -> None:
    one, other = routes(junction)
    human = car("HDV1", other, entry(junction, other, one) - 12.0, 8.0)
    ego = car("CAV1", one, entry(junction, one, other) - 14.0, 8.0)
    drive = coalition().drive(moment(junction, ego, human), ORDER)
    assert drive.actions == {"CAV1": Action.SLOWER}
    assert drive.expected["HDV1"]
    assert not drive.expected["HDV1"][0].progress
    gone = car("HDV1", other, entry(junction, other, one) + 40.0, 8.0)
    assert coalition().drive(moment(junction, ego, gone), ORDER).actions == {"CAV1": Action.FASTER}


def test_a_vehicle_that_follows_does_not_run_into_the_one_ahead(junction: Junction) -> None:
    route, _ = routes(junction)
    cars = car("CAV1", route, 34.0, 0.0), car("CAV2", route, 20.0, 8.0), car("HDV1", route, 42.0, 0.0)
    assert coalition().drive(moment(junction, *cars), ORDER).actions["CAV2"] is Action.SLOWER


def test_many_choose_together_and_always_the_same(junction: Junction) -> None:
    found = sorted(junction.road_map.routes)[:6]
    cars = [car(f"CAV{k}", route, 25.0 + 4.0 * k, 6.0) for k, route in enumerate(found)]
    drives = [coalition().drive(moment(junction, *cars), ORDER) for _ in range(2)]
    assert drives[0].actions == drives[1].actions
    assert list(drives[0].actions) == [c.id for c in cars]


def test_shares_are_told_if_asked_for(junction: Junction) -> None:
    one, other = routes(junction)
    cars = (
        car("CAV1", one, entry(junction, one, other) - 18.0, 8.0),
        car("CAV2", other, entry(junction, other, one) - 18.0, 8.0),
    )
    told, silent = (coalition(shares=shares).drive(moment(junction, *cars), ORDER) for shares in (True, False))
    assert told.actions == silent.actions
    assert all("its share" in reason for reason in told.reasons.values())
    assert not any("its share" in reason for reason in silent.reasons.values())


def test_only_what_the_road_allows_is_chosen(junction: Junction) -> None:
    route, _ = routes(junction)
    here = moment(junction, car("CAV1", route, 20.0, 4.0))
    bound = replace(here, available={"CAV1": (Action.SLOWER, Action.IDLE)})
    assert coalition().drive(bound, ORDER).actions == {"CAV1": Action.IDLE}


def test_without_vehicles_there_is_nothing_to_do(junction: Junction) -> None:
    empty = Moment(0.0, {}, {}, {}, {}, junction.road_map, Forecast(junction.model, LIBRARY))
    assert coalition().drive(empty, ORDER).actions == {}


def test_its_planner_has_no_plan(junction: Junction) -> None:
    route, _ = routes(junction)
    planner = coalition().planner(moment(junction, car("CAV1", route, 20.0, 4.0)))
    plan = planner.plan(["CAV1"])
    assert not plan.feasible
    assert planner.gap_time(plan, "CAV1", "CAV2") == float("inf")


def test_library_holds_actions_for_two_seconds_at_any_rate() -> None:
    for rate in (0.5, 1.0, 2.0, 2.5, 5.0):
        held = max(1, round(2.0 * rate))
        assert all((*(action,) * held, Action.FASTER) in LIBRARY for action in OPTIONS)
    assert len(LIBRARY) == len(set(LIBRARY))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"gap": -1}, "gap must be 0 to 5 s, got -1"),
        ({"participation": 1.1}, "participation must be 0 to 1, got 1.1"),
        ({"risk": -0.1}, "risk must be 0 to 1, got -0.1"),
        ({"reference_acceleration": 0}, "reference_acceleration must be 0.1 to 20 m/s2, got 0"),
        ({"hold": 5}, "hold must be 0.2 to 4 s, got 5"),
        ({"horizon": 11}, "horizon must be 1 to 10 s, got 11"),
    ],
)
def test_settings_out_of_range_are_refused(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ConfigError, match=message):
        coalition(**change)


def test_a_vehicle_that_has_to_change_lanes_stops_before_its_lane_ends(merge: Junction) -> None:
    ramp = next(r for r in sorted(merge.road_map.routes) if "ramp" in r)
    rooms = {}
    for place in np.arange(0.0, merge.road_map.paths[ramp].length - 30.0, 5.0):
        here = moment(merge, car("CAV1", ramp, float(place), 10.0))
        change = here.scenes["CAV1"].must_change
        if change is not None:
            rooms[change.room] = coalition().drive(here, ORDER).actions["CAV1"]
    assert rooms[min(rooms)] is Action.SLOWER
    assert rooms[max(rooms)] is Action.FASTER


def test_a_vehicle_that_came_first_is_shown_first() -> None:
    problem = instance(vehicle("a", 4), vehicle("b", 2), conflicts=[("a", "b")])
    rule = Arrival(60.0)
    rule.reset(0)
    assert (rule.name, rule.variant) == ("coop_game", "")
    assert rule.order(problem, Scheduled(problem)).sequence == ("b", "a")


def test_lane_changes_that_gain_most_together_are_granted() -> None:
    requests = [
        Request("a", Action.LANE_LEFT, 1.0, 0.0, frozenset("b")),
        Request("b", Action.LANE_LEFT, 2.0, 1.0, frozenset("a")),
    ]
    assert Arrival(60.0).grant(requests) == {"b"}
