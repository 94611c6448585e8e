"""Case-based reasoning: the memories speak for and against what the rules would do."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from remembered import memory
from worlds import Junction, car

from codriving.datatypes.experience import Memory, Verdict
from codriving.datatypes.order import PassingOrder
from codriving.datatypes.situation import ActionAssessment, Decision, Situation
from codriving.datatypes.world import Action
from codriving.reasoning.decision.cases import favour, reconsider
from codriving.reasoning.decision.rules import RuleDecider, decide_one

S, I, F, H = Action.SLOWER, Action.IDLE, Action.FASTER, Action.HOLD  # noqa: E741
BAD, GOOD, SLOW = Verdict.INTENSIFIED, Verdict.EASED, Verdict.TOO_CAUTIOUS


@pytest.fixture(scope="module")
def alone(junction: Junction) -> Situation:
    """A CAV on its own: everything is safe, and going fast gets it farthest."""
    scene = junction.thoughts(car("CAV1", "south-north", 40.0, 6.0)).scenes["CAV1"]
    gains = {F: 80.0, I: 60.0, S: 40.0, Action.LANE_LEFT: 90.0}
    assessed = tuple(ActionAssessment(a, True, (), (), gain) for a, gain in gains.items() if a is not Action.LANE_LEFT)
    return Situation(scene, (), PassingOrder((), ()), (), assessed)


def decided(situation: Situation, *memories: Memory) -> Decision:
    return RuleDecider().decide([replace(situation, memories=memories)])[0]


def test_without_memories_the_rules_decide(alone: Situation) -> None:
    assert decided(alone) == decide_one(alone)
    assert decided(alone).action is F


def test_a_mistake_is_not_repeated_if_something_else_is_safe(alone: Situation) -> None:
    found = decided(alone, memory(F, BAD, number=7))
    assert found.action is I
    assert found.recalled == (7,)
    assert found.reason == "FASTER intensified the conflict once in situations like this one, so IDLE"


def test_what_made_no_difference_speaks_neither_for_nor_against(alone: Situation) -> None:
    neutral = replace(memory(F, GOOD), verdict=Verdict.NEUTRAL)
    assert favour([neutral, memory(I, BAD)], F) == 0
    assert decided(alone, neutral).action is F


@pytest.mark.parametrize(("unsafe", "taken"), [((S,), I), ((I,), S), ((I, S), F)])
def test_what_the_safety_check_removed_is_no_way_out_of_a_mistake(
    alone: Situation, unsafe: tuple[Action, ...], taken: Action
) -> None:
    removed = [
        replace(a, safe=False, reasons=("same lane: no",)) if a.action in unsafe else a for a in alone.assessments
    ]
    assert decided(replace(alone, assessments=tuple(removed)), memory(F, BAD)).action is taken


def test_the_least_dangerous_action_is_taken_whatever_is_remembered(alone: Situation) -> None:
    forced = [replace(a, safe=a.action is S, reasons=("same lane: no",)) for a in alone.assessments]
    found = decided(replace(alone, assessments=tuple(forced)), memory(S, BAD), memory(F, GOOD))
    assert (found.action, found.reason) == (S, "no action is safe, and SLOWER is the least dangerous")


def test_nothing_unsafe_is_done_to_avoid_a_mistake(alone: Situation) -> None:
    only = replace(alone, assessments=tuple(replace(a, safe=a.action is F) for a in alone.assessments))
    assert decided(only, memory(F, BAD)).action is F


@pytest.mark.parametrize(("target", "instead"), [(9.0, I), (6.0, F), (3.0, H)])
def test_what_is_faster_than_idle_follows_from_the_target_speed(
    alone: Situation, target: float, instead: Action
) -> None:
    """At 6 m/s HOLD is slower than IDLE towards 9 m/s, as fast towards 6 m/s, and faster towards 3 m/s."""
    scene = replace(alone.scene, intent=replace(alone.scene.intent, target_speed=target))
    some = {9.0: (H, I), 6.0: (I, H, F), 3.0: (I, H)}[target]
    assessed = tuple(ActionAssessment(a, True, (), (), {F: 80.0, I: 60.0, H: 50.0}[a]) for a in some)
    situation = replace(alone, scene=scene, assessments=assessed)
    taken = H if target == 9.0 else I
    too_cautious = replace(situation, memories=(memory(taken, SLOW),))
    assert reconsider(too_cautious, Decision("CAV1", taken, "")).action is instead


def test_what_eased_the_conflict_is_preferred_to_what_gets_farther(alone: Situation) -> None:
    assert decided(alone, memory(F, BAD), memory(S, GOOD)).action is S


def test_of_two_mistakes_the_lesser_one(alone: Situation) -> None:
    both = memory(F, BAD, 0.99), memory(I, BAD, 0.92), memory(S, BAD, 0.95)
    assert decided(alone, *both).action is I


def test_cases_in_which_it_helped_outweigh_those_in_which_it_did_harm(alone: Situation) -> None:
    assert decided(alone, memory(F, BAD), memory(F, GOOD, count=4)).action is F
    assert decided(alone, memory(F, BAD, count=16), memory(F, GOOD, count=4)).action is I


def test_needless_caution_is_relaxed_but_not_into_a_mistake(alone: Situation) -> None:
    slow = replace(alone, assessments=tuple(replace(a, safe=a.action is not F) for a in alone.assessments))
    assert decide_one(slow).action is I
    careful = Decision("CAV1", S, "waits")
    told = replace(alone, memories=(memory(S, SLOW, number=3),))
    assert reconsider(told, careful).action is F
    assert reconsider(told, careful).recalled == (3,)
    warned = replace(alone, memories=(memory(S, SLOW), memory(F, BAD, count=8)))
    assert reconsider(warned, careful).action is I


def test_needless_caution_never_leads_to_more_of_it(alone: Situation) -> None:
    told = replace(alone, memories=(memory(I, SLOW), memory(S, GOOD), memory(F, BAD, count=64)))
    assert reconsider(told, Decision("CAV1", I, "waits")).action is I


def test_a_lane_change_that_was_a_mistake_is_not_begun(alone: Situation) -> None:
    left = replace(alone, memories=(memory(Action.LANE_LEFT, BAD),))
    assert reconsider(left, Decision("CAV1", Action.LANE_LEFT, "gets farther")).action is F


def test_if_no_action_is_safe_the_least_dangerous_one_stands(alone: Situation) -> None:
    reason = ("no action is safe; this one is the least dangerous",)
    forced = replace(
        alone,
        assessments=tuple(
            replace(a, safe=a.action is S, reasons=reason if a.action is S else ("bad",)) for a in alone.assessments
        ),
    )
    assert decided(forced, memory(S, BAD, count=99)).action is S


@given(
    st.lists(
        st.builds(
            memory,
            st.sampled_from([S, I, F]),
            st.sampled_from([BAD, GOOD, SLOW]),
            st.floats(0.5, 1),
            st.integers(1, 50),
        ),
        max_size=8,
    )
)
def test_whatever_is_remembered_a_safe_action_is_taken_that_is_no_worse(alone: Situation, found: list[Memory]) -> None:
    safe = replace(alone, assessments=tuple(replace(a, safe=a.action is not I) for a in alone.assessments))
    decision = decided(safe, *found)
    assert decision.action in safe.allowed
    assert favour(found, decision.action) >= min(0.0, favour(found, F))
    assert bool(decision.recalled) is (decision.action is not decide_one(safe).action)
