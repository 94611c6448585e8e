"""Orders that come late: from which step they stand, what stands before, and what is dropped."""

from collections import Counter
from dataclasses import replace
from typing import Any, cast

import pytest
from driven import planned
from thinkers import Backwards, Told
from worlds import FULL, Car, Junction, car, order_of

from codriving.datatypes.order import Instance
from codriving.datatypes.parts import RuleModel
from codriving.datatypes.situation import ReasonedDeliberation
from codriving.methods.codriving import CoDriving
from codriving.methods.ordered import Ordered
from codriving.reasoning.ordering.problem import pose
from codriving.reasoning.ordering.protocol import JointPlanner, Ordering
from codriving.reasoning.sharing.sharing import CdaLevel
from codriving.wrappers.delays import Delays
from codriving.wrappers.late_orders import LateOrders, LateRule
from codriving.wrappers.slow import Slow, SlowCoDriving

CAV1, CAV2 = car("CAV1", "south-north", 60.0, 8.0), car("CAV2", "west-east", 60.0, 8.0)
ONE, OTHER = order_of("CAV1 CAV2"), order_of("CAV2 CAV1")
GONE = car("CAV1", "south-north", 120.0, 8.0)
"""CAV1 past the junction."""


def slow(junction: Junction, seconds: float, told: Told | None = None, **change: Any) -> SlowCoDriving:
    made = SlowCoDriving(CoDriving(CdaLevel(**{**FULL, **change}), RuleModel(), None, 1.5), Delays(0.0, seconds))
    made.reset(junction.road_map, junction.model, 0)
    if told is not None:
        negotiation = made.codriving.pipeline.negotiation
        assert isinstance(negotiation, LateOrders)
        negotiation.coordinator.coordinator = told
    return made


def at(made: SlowCoDriving | Slow, junction: Junction, step: int, *cars: Car) -> ReasonedDeliberation:
    return made.act(junction.world(*(cars or (CAV1, CAV2)), time=0.5 * step, step=step))


def first(found: ReasonedDeliberation, ego: int = 0) -> str | None:
    return found.situations[ego].order.first_of("CAV1", "CAV2")


def test_an_order_stands_when_it_has_been_thought_of_and_until_the_next_one(junction: Junction) -> None:
    told = Told(OTHER, ONE, OTHER)
    made = slow(junction, 1.0, told)
    found = [at(made, junction, k) for k in range(6)]
    # Before the first one each goes by its own reading, in which both may go first.
    assert [(first(f, 0), first(f, 1)) for f in found[:2]] == [("CAV1", "CAV2")] * 2
    assert [first(f) for f in found[2:]] == ["CAV2", "CAV2", "CAV1", "CAV1"]
    assert [first(f, 1) for f in found[2:]] == ["CAV2", "CAV2", "CAV1", "CAV1"]
    assert told.asked == [0.0, 1.0, 2.0]
    assert [f.counts["late_orders"] for f in found] == [0, 0, 1, 0, 1, 0]
    assert found[2].situations[0].order.precedences[0].reason == "told so"


def test_an_order_about_cavs_that_have_gone_is_dropped_and_counted(junction: Junction) -> None:
    made = slow(junction, 1.0, Told(OTHER, order_of()))
    at(made, junction, 0)
    found = at(made, junction, 2, GONE, CAV2)
    assert (found.counts["dropped_orders"], found.counts["late_orders"]) == (1, 0)
    assert found.situations[0].order.precedences == ()


def test_an_order_that_contradicts_who_is_in_the_zone_is_dropped_and_the_last_valid_one_drives(
    junction: Junction,
) -> None:
    inside, waits = car("CAV1", "south-north", 96.0, 8.0), car("CAV2", "west-east", 70.0, 8.0)
    third = car("CAV3", "north-south", 60.0, 8.0)
    valid = replace(order_of("CAV1 CAV2", "CAV3 CAV2"), sequence=("CAV1", "CAV3", "CAV2"))
    late = order_of("CAV2 CAV1", "CAV2 CAV3")
    made = slow(junction, 1.0, Told(valid, late))
    for step in (0, 2):
        found = at(made, junction, step, CAV1, CAV2, third)
    assert (first(found), found.counts["late_orders"]) == ("CAV1", 1)
    found = at(made, junction, 4, inside, waits, third)
    assert (found.counts["dropped_orders"], found.counts["late_orders"]) == (1, 0)
    order = found.situations[0].order
    assert (order.first_of("CAV1", "CAV2"), order.first_of("CAV2", "CAV3")) == ("CAV1", "CAV3")
    # Where no order has been valid yet, each goes by its own still.
    made = slow(junction, 1.0, Told(late))
    at(made, junction, 0, CAV1, CAV2, third)
    found = at(made, junction, 2, inside, waits, third)
    assert found.counts["dropped_orders"] == 1
    assert found.situations[0].order.precedences[0].reason.startswith("own estimate: ")


def test_a_standing_order_gives_way_to_what_is_physically_fixed(junction: Junction) -> None:
    made = slow(junction, 1.0, Told(OTHER))
    at(made, junction, 0)
    assert first(at(made, junction, 2)) == "CAV2"
    assert first(at(made, junction, 3, car("CAV1", "south-north", 96.0, 8.0), CAV2)) == "CAV1"


def test_who_has_left_is_not_in_a_standing_order_and_who_came_since_goes_last(junction: Junction) -> None:
    made = slow(junction, 1.0, Told(OTHER))
    at(made, junction, 0)
    at(made, junction, 2)
    newcomer = car("CAV3", "east-west", 62.0, 8.0)
    order = at(made, junction, 3, CAV1, CAV2, newcomer).situations[0].order
    assert order.sequence == ("CAV2", "CAV1", "CAV3")
    assert order.first_of("CAV1", "CAV3") == "CAV1"
    left = at(made, junction, 3, CAV1, newcomer).situations[0].order
    assert left.sequence == ("CAV1", "CAV3")


def test_pairs_with_human_drivers_are_read_anew_each_step(junction: Junction) -> None:
    cavs = car("CAV1", "south-west", 80.0, 8.0), car("CAV2", "west-east", 70.0, 8.0)
    made = slow(junction, 2.0, Told(OTHER))
    for step in (0, 4):
        at(made, junction, step, *cavs)
    fast, creeps = (car("HDV1", "north-south", 86.0, speed) for speed in (8.0, 0.6))
    met = [at(made, junction, k, *cavs, h).situations[0].order for k, h in ((5, fast), (6, creeps))]
    assert [order.first_of("CAV1", "HDV1") for order in met] == ["HDV1", "CAV1"]
    assert [order.first_of("CAV1", "CAV2") for order in met] == ["CAV2", "CAV2"]


def test_where_nothing_is_open_between_cavs_no_time_is_taken(junction: Junction) -> None:
    told = Told(order_of(), order_of(), order_of(), OTHER)
    made = slow(junction, 1.0, told)
    for step in range(3):
        at(made, junction, step, CAV1)
    assert told.asked == [0.0, 0.5, 1.0]
    assert at(made, junction, 3).counts["late_orders"] == 0
    at(made, junction, 4)
    assert told.asked == [0.0, 0.5, 1.0, 1.5]


def test_without_negotiation_there_is_no_order_to_be_late(junction: Junction) -> None:
    found = at(slow(junction, 1.0, negotiation=False), junction, 0)
    assert found.situations[0].order.precedences[0].reason.startswith("own estimate: ")
    assert found.counts["late_orders"] == 0


@pytest.mark.parametrize("seconds", [0.5, 1.0, 2.0])
def test_the_order_of_a_method_that_orders_comes_late(seconds: float, junction: Junction) -> None:
    rule = Backwards()
    made = Slow(Ordered(rule, planned()), CdaLevel(**FULL), 1.5, Delays(0.0, seconds))
    made.reset(junction.road_map, junction.model, 0)
    late = car("CAV2", "west-east", 50.0, 8.0)
    found = [at(made, junction, k, CAV1, late) for k in range(6)]
    begins = round(2 * seconds)
    # Before the first one who can be there first goes first.
    assert [first(f) for f in found] == ["CAV1"] * begins + ["CAV2"] * (6 - begins)
    assert rule.asked == [0.5 * k for k in range(0, 6, begins)]
    assert sum(f.counts.get("asked", 0) for f in found) == len(rule.asked)
    assert found[begins].counts["late_orders"] == 1


class Holds(Backwards):
    """Holds the other one back for 9 s."""

    def order(self, instance: Instance, planner: JointPlanner) -> Ordering:
        return Ordering(("CAV2", "CAV1"), {"CAV2": 0.0, "CAV1": 9.0}, not_before={"CAV1": 9.0})


def test_a_late_rule_holds_no_cav_back_for_longer_than_it_said(junction: Junction) -> None:
    rule, planner = LateRule(Holds(), 1.0, Counter()), cast(JointPlanner, None)
    rule.reset(0)
    held = []
    for time in (0.0, 1.0, 1.5):
        held.append(rule.order(pose(junction.thoughts(CAV1, CAV2).moment(time)).instance, planner).not_before)
    assert held == [{}, {"CAV1": 8.0}, {"CAV1": 7.5}]
