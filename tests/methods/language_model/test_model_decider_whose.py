"""Whose decision it was, as the ledger counts it: of pairs, of decisions, and of what the rules would have done."""

import json

import pytest
from asked import deciding, orders, pairs, reasoned, sensible
from worlds import Junction, car

from codriving.datatypes.situation import Situation
from codriving.llm.ledger import Ledger
from codriving.llm.prompts.render import load_prompts
from codriving.llm.scripted import Script, ScriptedChat
from codriving.methods.language_model.model_coordinator import ModelCoordinator
from codriving.methods.language_model.model_decider import CheckedDecider
from codriving.methods.language_model.prompted_model import PromptedModel
from codriving.reasoning.decision.rules import RuleDecider
from codriving.reasoning.ordering.coordinator import RuleCoordinator

THREE = (
    car("CAV1", "south-north", 60, 8, 9),
    car("CAV2", "west-east", 62, 8, 9),
    car("CAV3", "east-south", 62, 8, 9),
)
CARS = (
    car("CAV1", "south-north", 60, 8, 9),
    car("CAV2", "west-east", 58, 7, 9),
    car("CAV3", "west-east", 45, 9),
    car("HDV1", "east-south", 50, 8),
)
OF_PAIRS = ("model_pairs", "mended_pairs", "repaired_pairs", "fallback_pairs")
OF_DECISIONS = ("model_decisions", "mended_decisions", "single_decisions", "fallback_decisions")


@pytest.fixture(scope="module")
def told(junction: Junction) -> tuple[Situation, ...]:
    """What three CAVs are told at the junction; one of them has one action left."""
    return reasoned(junction, sensible).method.act(junction.world(*CARS)).situations


def negotiated(junction: Junction, script: Script) -> tuple[dict[str, float], int]:
    """What is counted of one negotiation, and how many of its three pairs are as the rules have them."""
    ledger, thoughts = Ledger(), junction.thoughts(*THREE)
    made = ModelCoordinator(PromptedModel(ScriptedChat(script), load_prompts("planner"), ledger), False)
    order = made.negotiate(thoughts.moment())
    by_rule = RuleCoordinator(False).negotiate(thoughts.moment())
    alike = {(p.first, p.second) for p in order.precedences} & {(p.first, p.second) for p in by_rule.precedences}
    return ledger.close_step(0.0)[0], len(alike)


def last_first(number: int) -> Script:
    """Orders so many pairs, the last-named vehicle first."""
    return lambda q: orders(*[(name, max(pair)) for name, pair in pairs(q).items()][:number])


@pytest.mark.parametrize(("said", "by_model", "repaired"), [(3, 3, 0), (1, 1, 2)])
def test_pairs_that_an_answer_leaves_out_are_not_the_models(
    junction: Junction, said: int, by_model: int, repaired: int
) -> None:
    counts, alike = negotiated(junction, last_first(said))
    assert [counts[name] for name in OF_PAIRS] == [by_model, 0, repaired, 0]
    if said == 3:
        assert counts["pairs_as_rules"] == alike < 3


def test_without_an_answer_all_pairs_are_ordered_by_rule(junction: Junction) -> None:
    counts, _ = negotiated(junction, lambda q: "I cannot say.")
    assert [counts[name] for name in OF_PAIRS] == [0, 0, 0, 3]


def test_pairs_read_tolerantly_are_the_models_and_mended(junction: Junction) -> None:
    counts, _ = negotiated(junction, lambda q: last_first(3)(q).replace('"', "'"))  # type: ignore[union-attr,arg-type]
    assert [counts[name] for name in OF_PAIRS] == [3, 3, 0, 0]


def test_a_shadow_of_the_rules_leaves_no_trace(junction: Junction) -> None:
    thoughts = junction.thoughts(*THREE)
    ledger = Ledger()
    made = ModelCoordinator(PromptedModel(ScriptedChat(last_first(3)), load_prompts("planner"), ledger), False)
    order = made.negotiate(thoughts.moment())
    assert made.rules.previous is order


def decided(told: tuple[Situation, ...], script: Script) -> dict[str, float]:
    ledger = Ledger()
    CheckedDecider(PromptedModel(ScriptedChat(script), load_prompts("planner"), ledger), True, True).decide(told)
    return ledger.close_step(0.0)[0]


def test_a_choice_of_one_is_nobodys_decision(told: tuple[Situation, ...]) -> None:
    assert [len(s.allowed) for s in told].count(1) == 1
    slow = json.dumps({"reason": "", "action": "SLOWER"})
    counts = decided(told, deciding(slow))
    assert [counts[name] for name in OF_DECISIONS] == [2, 0, 1, 0]
    rules = [RuleDecider().decide([s])[0].action for s in told if len(s.allowed) > 1]
    assert counts["decisions_as_rules"] == sum(action == "SLOWER" for action in rules)


def test_a_choice_of_one_that_is_not_asked_for_is_single_and_not_plain(
    junction: Junction, told: tuple[Situation, ...]
) -> None:
    alone = reasoned(junction, sensible).method.act(junction.world(car("CAV9", "south-north", 20, 8))).situations
    [one] = [s for s in told if len(s.allowed) == 1]
    ledger = Ledger()
    model = PromptedModel(ScriptedChat(lambda q: "must not be asked"), load_prompts("informed"), ledger)
    CheckedDecider(model, False, True).decide((one, *alone))
    counts = ledger.close_step(0.0)[0]
    assert counts.get("model_calls", 0) == 0
    assert (counts["single_decisions"], counts["plain_decisions"]) == (1, 1)


def test_what_the_rules_would_have_chosen_is_as_the_rules(told: tuple[Situation, ...]) -> None:
    rules = {s.scene.ego.id: str(RuleDecider().decide([s])[0].action) for s in told}
    counts = decided(told, lambda q: json.dumps({"reason": "", "action": rules[q.subject]}))
    assert counts["decisions_as_rules"] == counts["model_decisions"] == 2


def test_mended_and_missing_decisions_are_told_apart(told: tuple[Situation, ...]) -> None:
    counts = decided(told, lambda q: "{'action': 'SLOWER'}" if q.subject == "CAV1" else "no")
    assert [counts[name] for name in OF_DECISIONS] == [1, 1, 1, 1]


def test_a_step_without_questions_counts_nothing_as_zeros() -> None:
    counts, lines = Ledger().close_step(0.0)
    assert {counts[name] for name in (*OF_PAIRS, *OF_DECISIONS)} == {0}
    assert not lines
