"""What is asked about human drivers, and that the answer is used within the safety check."""

from collections.abc import Sequence
from dataclasses import replace
from math import nan

import pytest
from worlds import Car, Junction, car

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.judgement import Judgement, Judgements
from codriving.datatypes.parts import CaseMemory, Model, RuleModel
from codriving.datatypes.situation import ReasonedDeliberation, Situation
from codriving.datatypes.world import Action, WorldState
from codriving.geometry.road_map import RoadMap
from codriving.judgement.contests import Contest
from codriving.judgement.judge import Asked, Judge, relying_on
from codriving.methods.codriving import CoDriving
from codriving.methods.ordered import Ordered

YIELDS, GOES = Judgement(0.9, "yields", "it brakes"), Judgement(0.1, "goes", "it does not brake")
UNCLEAR = Judgement(0.5, "unclear", "it may do either")


class Fixed(Judge):
    """Says the same of all, or nothing, and keeps what it was asked."""

    name = "fixed"

    def __init__(self, given: Judgement | None) -> None:
        self.given = given

    def reset(self, road_map: RoadMap, model: Asked | None) -> None:
        """Begin."""
        self.asked: list[Contest] = []

    def judge(self, asked: Sequence[Contest]) -> Judgements:
        """Answer all with the one answer, if there is one."""
        self.asked += asked
        return {} if self.given is None else {(c.cav, c.human): self.given for c in asked}


def made(*overrides: str) -> CoDriving | Ordered:
    """A method as it is configured."""
    node = compose(overrides)["method"]
    given = {Model: RuleModel(), CaseMemory: None} if node["_target_"].endswith("CoDriving") else {}
    method = build(node, object, "method", given=given)
    assert isinstance(method, CoDriving | Ordered)
    return method


def seen(method: CoDriving | Ordered, junction: Junction, world: WorldState) -> Situation:
    """What CAV1 decides by."""
    method.reset(junction.road_map, junction.model, 3)
    deliberation = method.act(world)
    assert isinstance(deliberation, ReasonedDeliberation)
    return next(s for s in deliberation.situations if s.scene.ego.id == "CAV1")


def first(junction: Junction, world: WorldState, given: Judgement | None, *overrides: str) -> tuple[str | None, str]:
    """Who goes first of CAV1 and HDV1, and why, if the judge says one thing."""
    method = made(*overrides)
    method.rely_on(Fixed(given))
    order = seen(method, junction, world).order
    return order.first_of("CAV1", "HDV1"), " ".join(p.reason for p in order.precedences)


def rivals(junction: Junction, mine: str, theirs: str, *others: Car) -> WorldState:
    """A CAV and a human driver who would be at their zone about as soon."""
    return junction.world(car("CAV1", mine, 80.0, 8.0, 9.0), car("HDV1", theirs, 76.0, 8.0), *others)


METHODS = [("method=codriving",), ("method=fcfs",), ("method=fcfs", "executor.humans=checked")]


@pytest.mark.parametrize("method", METHODS)
def test_the_answer_turns_the_order(method: tuple[str, ...], junction: Junction) -> None:
    # The road that runs from east to west has the right of way here.
    prior, lower = rivals(junction, "east-west", "south-north"), rivals(junction, "south-north", "east-west")
    assert first(junction, prior, None, *method)[0] == "CAV1"
    assert first(junction, prior, GOES, *method)[0] == "HDV1"
    assert first(junction, lower, None, *method)[0] == "HDV1"
    assert first(junction, lower, YIELDS, *method) == ("CAV1", "it brakes")


def test_what_is_unclear_missing_or_no_answer_is_left_to_the_rules(junction: Junction) -> None:
    prior, lower = rivals(junction, "east-west", "south-north"), rivals(junction, "south-north", "east-west")
    for world in (prior, lower):
        ruled = seen(made("method=codriving"), junction, world).order
        for given in (None, UNCLEAR, Judgement(1.1, "yields", ""), Judgement(nan, "goes", "")):
            method = made("method=codriving")
            method.rely_on(Fixed(given))
            assert seen(method, junction, world).order == ruled


def test_a_driver_in_the_zone_has_to_leave_it_whatever_was_said(junction: Junction) -> None:
    thoughts = junction.thoughts(car("CAV1", "east-west", 80.0, 8.0, 9.0), car("HDV1", "south-north", 76.0, 8.0))
    c, human = thoughts.conflicts["CAV1"][0], thoughts.scenes["CAV1"].vehicles()["HDV1"]
    inside = replace(c, distances=(c.distances[0], 0.0))
    says = relying_on({("CAV1", "HDV1"): YIELDS}, lambda c, human, road_map: "by rule")
    assert [says(each, human, junction.road_map) for each in (c, inside)] == ["it brakes", "by rule"]


def test_the_answer_changes_what_the_safety_check_allows(junction: Junction) -> None:
    """Close to the zone: only a driver who is relied on to give way lets the CAV accelerate."""
    world = junction.world(car("CAV1", "south-north", 98.0, 6.0, 6.0), car("HDV1", "east-west", 82.0, 8.0))
    allowed = {}
    for given in (GOES, YIELDS):
        method = made("method=codriving")
        method.rely_on(Fixed(given))
        allowed[given.answer] = seen(method, junction, world).allowed
    assert Action.FASTER in allowed["yields"]
    assert Action.FASTER not in allowed["goes"]


def test_a_yes_does_not_lift_the_check_of_bodies(junction: Junction) -> None:
    """A driver who can no longer stop before the CAV is not driven into, whatever is said of it."""
    world = junction.world(car("CAV1", "south-north", 100.0, 8.0, 9.0), car("HDV1", "east-west", 101.0, 9.0))
    method = made("method=codriving")
    method.rely_on(Fixed(YIELDS))
    assert Action.FASTER not in seen(method, junction, world).allowed


def test_only_open_pairs_are_asked_about(junction: Junction) -> None:
    near = rivals(junction, "east-west", "south-north", car("HDV2", "east-west", 60.0, 8.0))
    method, judge = made("method=codriving"), Fixed(None)
    method.rely_on(judge)
    seen(method, junction, near)
    assert [(c.cav, c.human) for c in judge.asked] == [("CAV1", "HDV1")]  # HDV2 follows
    numbers = judge.asked[0].numbers
    assert (numbers["cav_speed"], numbers["human_speed"], numbers["priority"]) == (8.0, 8.0, 1.0)
    assert judge.asked[0].rule.startswith("the CAV has the right of way")
    # Through before the driver can be there; and a driver who is gone before the CAV can be there.
    for ahead, behind in ((100.0, 60.0), (60.0, 108.0)):
        world = junction.world(car("CAV1", "east-west", ahead, 8.0, 9.0), car("HDV1", "south-north", behind, 8.0))
        seen(method, junction, world)
        assert judge.asked == []


def test_a_line_of_decisions_holds_what_was_judged_and_only_then(junction: Junction) -> None:
    world = rivals(junction, "south-north", "east-west")
    method = made("method=codriving")
    method.reset(junction.road_map, junction.model, 3)
    assert "judgements" not in method.act(world).as_dict()["cavs"][0]
    method.rely_on(Fixed(YIELDS))
    method.reset(junction.road_map, junction.model, 3)
    judged = {"HDV1": {"yields": 0.9, "answer": "yields", "reason": "it brakes"}}
    assert method.act(world).as_dict()["cavs"][0]["judgements"] == judged


def test_the_variant_says_who_judges() -> None:
    assert made("method=codriving").variant == "full"
    assert made("method=codriving", "judgement=earliest").variant == "judgement=earliest"
    assert made("method=fcfs", "judgement=always").variant == "judgement=always"
    assert made("method=codriving", "cda=prescriptive", "judgement=never").variant == "full/binding/judgement=never"
    assert made("method=codriving", "judgement=oracle").knows_drivers


def test_rules_that_are_noted_drive_as_the_rules_do(junction: Junction) -> None:
    world = rivals(junction, "east-west", "south-north", car("CAV2", "north-south", 80.0, 8.0, 9.0))
    ruled = seen(made("method=codriving"), junction, world)
    found = seen(made("method=codriving", "judgement=rules_noted"), junction, world)
    assert found.judgements["HDV1"].answer == "yields"
    assert found.assessments == ruled.assessments
    assert found.order.sequence == ruled.order.sequence
