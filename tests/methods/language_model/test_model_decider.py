"""Decisions by a model: who is asked, what may be chosen, and what stands in for an answer."""

import json
from collections.abc import Callable
from dataclasses import replace

import pytest
from asked import Reasoned, allowed, deciding, reasoned, sensible, shown
from remembered import memory
from worlds import Junction, car

from codriving.datatypes.situation import ActionAssessment, Situation
from codriving.datatypes.world import Action
from codriving.llm.ledger import Ledger
from codriving.llm.prompts.render import load_prompts
from codriving.llm.prompts.replies import decision_reply
from codriving.llm.question import Answer, Question
from codriving.llm.scripted import Script, ScriptedChat
from codriving.methods.language_model.model_decider import CheckedDecider
from codriving.methods.language_model.prompted_model import PromptedModel
from codriving.reasoning.decision.rules import RuleDecider

CARS = (
    car("CAV1", "south-north", 60, 8, 9),
    car("CAV2", "west-east", 58, 7, 9),
    car("CAV3", "west-east", 45, 9),
    car("HDV1", "east-south", 50, 8),
)


@pytest.fixture(scope="module")
def told(junction: Junction) -> tuple[Situation, ...]:
    """What three CAVs are told at the junction; IDLE and FASTER have been removed for CAV3."""
    return reasoned(junction, sensible).method.act(junction.world(*CARS)).situations


def decider(script: Script, ask_plain: bool = False) -> tuple[CheckedDecider, ScriptedChat, Ledger]:
    chat, ledger = ScriptedChat(script), Ledger()
    return CheckedDecider(PromptedModel(chat, load_prompts("planner"), ledger), ask_plain, True), chat, ledger


def says(action: str) -> str:
    return json.dumps({"reason": "so it shall be", "action": action})


def test_all_are_asked_at_once(told: tuple[Situation, ...]) -> None:
    made, chat, ledger = decider(deciding(says("SLOWER")))
    decisions = made.decide(told)
    assert [(d.ego, d.action, d.reason) for d in decisions] == [
        (s.scene.ego.id, Action.SLOWER, "so it shall be") for s in told
    ]
    assert chat.rounds == 1
    assert [(q.purpose, q.subject) for q in chat.questions] == [("decide", s.scene.ego.id) for s in told]
    assert [line["subject"] for line in ledger.close_step(0.0)[1]] == ["CAV1", "CAV2", "CAV3"]


def test_model_sees_system_and_user_message(told: tuple[Situation, ...]) -> None:
    made, _, _ = decider(sensible)
    for situation in told:
        question = made.question(situation)
        assert [m.role for m in question.messages] == ["system", "user"]
        assert allowed(question) == [str(a) for a in situation.allowed]


@pytest.mark.parametrize("wrong", ["FASTER", "fly", "SLOWER or IDLE", "", "<script>"])
def test_action_that_is_not_allowed_is_asked_for_again_by_name(told: tuple[Situation, ...], wrong: str) -> None:
    assert told[2].allowed == (Action.SLOWER,)
    made, chat, ledger = decider(deciding(says(wrong), says("slower")))
    [decision] = made.decide(told[2:])
    assert decision.action is Action.SLOWER
    complaint = shown(chat.questions[1])
    assert "choose one of: SLOWER" in complaint
    assert ("same lane" in complaint) is (wrong == "FASTER")
    counts, _ = ledger.close_step(0.0)
    assert (counts["re_asks"], counts["fallbacks"]) == (1, 0)


def test_answer_that_only_the_tolerant_reading_understands_is_counted_and_costs_no_question(
    told: tuple[Situation, ...],
) -> None:
    made, chat, ledger = decider(deciding("{'reason': 'close', 'action': 'slower',}"))
    [decision] = made.decide(told[2:])
    assert (decision.action, decision.reason) == (Action.SLOWER, "close")
    counts, [line] = ledger.close_step(0.0)
    assert (chat.calls, counts["mended"], counts["re_asks"], counts["fallbacks"]) == (1, 1, 0, 0)
    assert line["mended"] is True


@pytest.mark.parametrize("text", ["", "{}", "no idea", says("FASTER"), says("fly"), "<html>busy</html>", "null"])
def test_without_a_usable_answer_the_safest_action_is_taken_and_counted(told: tuple[Situation, ...], text: str) -> None:
    made, chat, ledger = decider(deciding(text))
    [decision] = made.decide(told[2:])
    assert decision.action is Action.SLOWER
    assert decision.reason.startswith("fallback, no usable answer: ")
    counts, lines = ledger.close_step(0.0)
    assert (chat.calls, counts["re_asks"], counts["fallbacks"]) == (2, 1, 1)
    assert lines[0]["value"] is None


def test_one_that_does_not_answer_does_not_disturb_the_others(told: tuple[Situation, ...]) -> None:
    made, _, ledger = decider(lambda q: "" if q.subject == "CAV2" else says("SLOWER"))
    decisions = made.decide(told)
    assert [d.reason.startswith("fallback") for d in decisions] == [False, True, False]
    assert ledger.close_step(0.0)[0]["fallbacks"] == 1


@pytest.mark.parametrize(
    ("gains", "safe", "action"),
    [
        ((40.0, 50.0, 60.0), (True, True, True), Action.SLOWER),
        ((None, 50.0, 60.0), (True, True, True), Action.IDLE),
        ((40.0, 50.0, 60.0), (False, False, True), Action.FASTER),
        ((None, None, None), (True, True, True), Action.SLOWER),
        ((40.0, None, None), (False, True, True), Action.IDLE),
    ],
)
def test_fallback_is_the_slowest_that_is_safe_and_keeps_the_order(
    told: tuple[Situation, ...], gains: tuple[float | None, ...], safe: tuple[bool, ...], action: Action
) -> None:
    actions = (Action.SLOWER, Action.IDLE, Action.FASTER)
    made = tuple(
        ActionAssessment(a, ok, () if ok else ("no",), (), gain)
        for a, ok, gain in zip(actions, safe, gains, strict=True)
    )
    made_by_hand = replace(told[0], assessments=made)
    assert decider(sensible)[0].substitute(made_by_hand) is action


def test_chat_that_checks_nothing_can_do_nothing_forbidden(told: tuple[Situation, ...]) -> None:
    class Careless:
        name = "careless"

        def ask(self, questions: list[Question]) -> list[Answer]:
            return [Answer(decision_reply(("FASTER",)).model_validate({"action": "FASTER"}), ()) for _ in questions]

    ledger = Ledger()
    [decision] = CheckedDecider(PromptedModel(Careless(), load_prompts("planner"), ledger), False, True).decide(
        told[2:]
    )
    assert decision.action is Action.SLOWER
    assert ledger.close_step(0.0)[0]["fallbacks"] == 1


def test_plain_decisions_are_not_asked_for_unless_wanted(junction: Junction, told: tuple[Situation, ...]) -> None:
    alone = reasoned(junction, sensible).method.act(junction.world(car("CAV9", "south-north", 20, 8))).situations
    for ask_plain in (False, True):
        made, chat, ledger = decider(deciding(says("SLOWER")), ask_plain)
        decisions = made.decide((*told[:1], *alone))
        assert [q.subject for q in chat.questions] == (["CAV1", "CAV9"] if ask_plain else ["CAV1"])
        assert ledger.close_step(0.0)[0].get("plain_decisions", 0) == (not ask_plain)
        if not ask_plain:
            assert decisions[1:] == RuleDecider().decide(alone)


def test_chat_is_left_alone_if_there_is_nothing_to_ask(junction: Junction) -> None:
    alone = reasoned(junction, sensible).method.act(junction.world(car("CAV9", "south-north", 20, 8))).situations
    made, chat, _ = decider(deciding("must not be asked"))
    assert made.decide(()) == []
    assert made.decide(alone) == RuleDecider().decide(alone)
    assert (chat.rounds, chat.calls) == (0, 0)


def test_shorter_question_loses_memories_then_the_farther_vehicles(told: tuple[Situation, ...]) -> None:
    made, _, _ = decider(sensible)
    question = made.question(replace(told[0], memories=(replace(memory(), text="Remember to yield."),)))
    texts = [shown(question)]
    while (shorter := question.shorter()) is not None:
        question = shorter
        texts.append(shown(question))
        assert allowed(question) == [str(a) for a in told[0].allowed]
    assert ["Remember" in text for text in texts] == [True, False, False]
    assert [("CAV2" in text, "CAV3" in text) for text in texts[:2]] == [(True, True), (True, True)]
    assert "CAV3" not in texts[2]
    assert sum(map(len, texts[2:])) < len(texts[1])


def test_model_may_choose_among_the_allowed_only(junction: Junction) -> None:
    made: Callable[[str], Reasoned] = lambda action: reasoned(junction, deciding(says(action)))  # noqa: E731
    for action in Action:
        deliberation = made(action).method.act(junction.world(*CARS))
        for situation, decision in zip(deliberation.situations, deliberation.decisions, strict=True):
            assert decision.action in situation.allowed
