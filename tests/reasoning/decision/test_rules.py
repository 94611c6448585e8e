"""The built-in decider picks only what it is allowed, and says why."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from worlds import Car, Junction, Thoughts, car, order_of

from codriving.datatypes.order import PassingOrder
from codriving.datatypes.situation import ActionAssessment, Situation
from codriving.datatypes.world import Action
from codriving.reasoning.decision.rules import RuleDecider, decide_one
from codriving.reasoning.safety.assessment import ThreeLayers

NOBODY = PassingOrder((), ())
SAFE = st.tuples(st.booleans(), st.none() | st.floats(0.0, 90.0))


def situation(
    junction: Junction,
    assessments: dict[Action, tuple[bool, float | None]],
    order: PassingOrder = NOBODY,
    me: Car | None = None,
) -> Situation:
    """What CAV1 is told, with a safety check made by hand: whether an action is safe, and how far it gets."""
    thoughts = junction.thoughts(me or car("CAV1", "south-north", 60.0, 6.0))
    made = tuple(
        ActionAssessment(action, safe, () if safe else ("same lane: no",), (), progress)
        for action, (safe, progress) in assessments.items()
    )
    return Situation(thoughts.scenes["CAV1"], (), order, (), made)


def assessed(thoughts: Thoughts, ego: str) -> Situation:
    given = thoughts.safety_input(ego)
    return Situation(given.scene, given.conflicts, given.order, (), ThreeLayers().assess(given))


@given(st.fixed_dictionaries(dict.fromkeys(Action, SAFE)))
def test_only_allowed_actions_are_taken_and_always_with_a_reason(
    junction: Junction, assessments: dict[Action, tuple[bool, float | None]]
) -> None:
    told = situation(junction, assessments)
    if not told.allowed:
        return
    decision = decide_one(told)
    assert decision.ego == "CAV1"
    assert decision.action in told.allowed
    assert decision.reason


def test_the_fastest_of_those_that_get_equally_far(junction: Junction) -> None:
    told = situation(junction, {Action.SLOWER: (True, 80.0), Action.IDLE: (True, 80.0), Action.FASTER: (True, 80.0)})
    assert decide_one(told).action is Action.FASTER


@pytest.mark.parametrize(
    ("target", "fastest"), [(9.0, Action.FASTER), (6.0, Action.FASTER), (3.0, Action.HOLD), (5.69, Action.HOLD)]
)
def test_what_was_begun_is_not_taken_back_if_holding_gets_as_far(
    target: float, fastest: Action, junction: Junction
) -> None:
    along = (Action.SLOWER, Action.IDLE, Action.HOLD, Action.FASTER)
    me = car("CAV1", "south-north", 60.0, 6.0, target)
    assert decide_one(situation(junction, dict.fromkeys(along, (True, 80.0)), me=me)).action is fastest
    far = {**dict.fromkeys(along, (True, 78.3)), Action.FASTER: (True, 80.0)}
    assert decide_one(situation(junction, far, me=me)).action is Action.FASTER, "more than 2 % farther"
    five = dict.fromkeys((Action.SLOWER, Action.IDLE, Action.FASTER), (True, 80.0))
    assert decide_one(situation(junction, five, me=me)).action is Action.FASTER


def test_the_best_may_be_worth_less_than_nothing(junction: Junction) -> None:
    gains = {Action.SLOWER: (True, -0.7), Action.IDLE: (True, -0.5), Action.HOLD: (True, None)}
    assert decide_one(situation(junction, gains)).action is Action.IDLE


def test_accelerating_is_not_taken_back_either(junction: Junction) -> None:
    gains = {Action.SLOWER: (True, 80.0), Action.IDLE: (True, 10.0), Action.HOLD: (True, 79.0)}
    assert decide_one(situation(junction, gains, me=car("CAV1", "south-north", 60.0, 6.0, 9.0))).action is Action.HOLD


def test_much_more_progress_is_worth_waiting_for(junction: Junction) -> None:
    told = situation(
        junction,
        {Action.SLOWER: (True, 80.0), Action.IDLE: (True, 10.0), Action.FASTER: (True, 5.0)},
        order_of("CAV2 CAV1"),
    )
    decision = decide_one(told)
    assert decision.action is Action.SLOWER
    assert "CAV2" in decision.reason


def test_an_action_that_breaks_the_order_is_not_taken_while_another_keeps_it(junction: Junction) -> None:
    told = situation(
        junction,
        {Action.SLOWER: (True, 30.0), Action.IDLE: (True, None), Action.FASTER: (True, None)},
        order_of("CAV2 CAV1"),
    )
    assert decide_one(told).action is Action.SLOWER


@pytest.mark.parametrize("left", [Action.FASTER, Action.IDLE, Action.SLOWER])
def test_the_reason_fits_the_action_when_the_order_cannot_be_kept(left: Action, junction: Junction) -> None:
    told = situation(junction, {a: (a is left, None) for a in (Action.SLOWER, Action.IDLE, Action.FASTER)})
    decision = decide_one(told)
    assert decision.action is left
    assert left in decision.reason
    assert "slow down" not in decision.reason


def test_a_forced_action_is_called_the_least_dangerous(junction: Junction) -> None:
    thoughts = junction.thoughts(car("CAV1", "south-north", 60.0, 9.0), car("HDV1", "south-north", 67.0, 0.0))
    decision = decide_one(assessed(thoughts, "CAV1"))
    assert decision.action is Action.SLOWER
    assert "least dangerous" in decision.reason


def test_one_decision_a_situation_in_the_same_order(junction: Junction) -> None:
    thoughts = junction.thoughts(car("CAV1", "south-north", 60.0, 6.0), car("CAV2", "west-east", 60.0, 6.0))
    told = [assessed(thoughts, ego) for ego in ("CAV2", "CAV1")]
    assert [d.ego for d in RuleDecider().decide(told)] == ["CAV2", "CAV1"]
    assert RuleDecider().decide([]) == []
