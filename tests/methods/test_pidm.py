"""PIDM: free road, real leaders, projected leaders, and starting after a wait."""

from dataclasses import replace

import pytest
from seeing import decide, pidm, seen, seen_each
from worlds import Junction, car

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.world import Action
from codriving.errors import ConfigError
from codriving.methods.pidm import LIMITS
from codriving.methods.single_vehicle.encounters import TURN

EGO = car("CAV1", "south-north", 70.0, 6.0)


def test_alone_it_accelerates_at_any_speed_below_the_top(junction: Junction) -> None:
    for speed in (0.0, 0.01, 3.0, 6.0):
        choice = decide(pidm(), junction, car("CAV1", "south-north", 40.0, speed))
        assert (choice.action, choice.precedences) == (Action.FASTER, ())
        assert choice.reason.startswith("no vehicle holds it up")
    assert decide(pidm(), junction, car("CAV1", "south-north", 40.0, 9.0)).action is Action.IDLE


def test_it_slows_down_behind_a_vehicle_that_stands_on_its_lane(junction: Junction) -> None:
    choice = decide(pidm(), junction, EGO, car("HDV1", "south-north", 84.0, 0.0))
    assert choice.action is Action.SLOWER
    assert choice.reason.startswith("HDV1 is ahead")


def test_far_behind_a_faster_vehicle_it_accelerates(junction: Junction) -> None:
    assert decide(pidm(), junction, EGO, car("HDV1", "south-north", 110.0, 8.0)).action is Action.FASTER


def test_it_lets_go_first_who_is_there_first_and_is_told_why(junction: Junction) -> None:
    ego = car("CAV1", "south-north", 92.0, 6.0)
    choice = decide(pidm(), junction, ego, car("HDV1", "west-east", 102.0, 6.0))
    assert choice.action is Action.SLOWER
    assert "HDV1 goes first" in choice.reason
    assert [(p.first, p.second) for p in choice.precedences] == [("HDV1", "CAV1")]


def test_it_goes_first_if_the_other_one_is_far_away(junction: Junction) -> None:
    ego = car("CAV1", "south-north", 92.0, 6.0)
    choice = decide(pidm(), junction, ego, car("HDV1", "west-east", 76.0, 5.0))
    assert choice.action is Action.FASTER
    assert [(p.first, p.second) for p in choice.precedences] == [("CAV1", "HDV1")]


def test_a_projected_leader_costs_no_more_than_to_wait_before_the_zone(junction: Junction) -> None:
    # Right behind its projection; to wait before the zone needs no braking yet.
    far = car("CAV1", "south-north", 80.0, 6.0)
    choice = decide(pidm(), junction, far, car("HDV1", "west-east", 88.0, 6.0))
    assert [(p.first, p.second) for p in choice.precedences] == [("HDV1", "CAV1")]
    assert choice.action is not Action.SLOWER, "there is room enough to slow down later"


def test_who_has_waited_long_enough_starts_into_an_empty_zone(junction: Junction) -> None:
    waits = (car("CAV1", "south-north", 102.0, 0.0), car("HDV1", "west-east", 107.0, 0.0))
    driver = pidm()
    found = seen_each(junction, [waits] * 12)
    actions = [driver.decide(*view).action for view in found]
    patience = round(driver.patience / junction.model.decision_interval)
    assert Action.FASTER not in actions[:patience]
    assert set(actions[patience:]) == {Action.FASTER}


def test_no_vehicle_starts_into_a_zone_in_which_a_vehicle_stands(junction: Junction) -> None:
    stuck = (car("CAV1", "south-north", 102.0, 0.0), car("HDV1", "west-east", 112.0, 0.0))
    driver = pidm()
    assert all(driver.decide(*view).action is not Action.FASTER for view in seen_each(junction, [stuck] * 12))


def test_who_waits_forgets_it_when_an_episode_begins(junction: Junction) -> None:
    waits = (car("CAV1", "south-north", 102.0, 0.0), car("HDV1", "west-east", 107.0, 0.0))
    driver = pidm()
    for view in seen_each(junction, [waits] * 12):
        driver.decide(*view)
    driver.reset()
    assert driver.decide(*seen(junction, *waits, time=20.0)).action is not Action.FASTER


def test_the_end_of_a_lane_stands_still(merge: Junction) -> None:
    route = next(r.id for r in merge.road_map.routes.values() if merge.road_map.changes.ahead(r.id, 0.0) is not None)
    last = merge.road_map.changes.ahead(route, 0.0)
    assert last is not None
    blocked = car("CAV1", route, last[2] - 12.0, 10.0)
    moment, ego = seen(merge, blocked)
    choice = pidm().decide(replace(moment, available={ego: moment.available[ego][:3]}), ego)
    assert choice.action is Action.SLOWER
    assert choice.reason.startswith("the end of the lane is ahead")


@pytest.mark.parametrize("key", sorted(LIMITS))
def test_settings_out_of_range_are_refused(key: str) -> None:
    node, (low, high) = compose(["method=pidm"])["method"], LIMITS[key]
    for value in (low - 1, high + 1):
        with pytest.raises(ConfigError, match=f"{key} must be "):
            build({**node, "driver": {**node["driver"], key: value}}, object)


def test_of_those_who_wait_each_starts_after_the_one_before(junction: Junction) -> None:
    # Both have been standing for as long; CAV1 is named first, and CAV2 gives it a second to start.
    waits = (car("CAV1", "south-north", 102.0, 0.0), car("CAV2", "west-east", 106.0, 0.0))
    driver = pidm()
    actions = [driver.decide(*view).action for view in seen_each(junction, [waits] * 16, "CAV2")]
    assert actions.index(Action.FASTER) == round((driver.patience + TURN) / junction.model.decision_interval)


def test_no_vehicle_waits_inside_another_crossing(junction: Junction) -> None:
    # HDV1 comes from the right and goes first; the CAV is first before HDV2, whose crossing lies on the way.
    ego, right = car("CAV1", "south-north", 97.0, 3.0), car("HDV1", "east-west", 103.0, 6.0)
    left = car("HDV2", "west-east", 78.0, 4.0)
    driver = pidm()
    lines = {}
    for cars in ((ego, right), (ego, right, left)):
        view = seen(junction, *cars)
        met = driver.met(*view)
        (e,) = [e for e in met if e.conflict.routes[1] == "east-west"]
        lines[len(cars)] = driver._line(e, met)
        zones = junction.road_map.zones("south-north", "west-east")
    assert lines[2] == pytest.approx(e.own_way - driver.stop_gap)
    assert lines[3] < zones[0].entry_i - ego.place
