"""The prompts ``informed``: who is asked, what is remembered, what pairs are called, and thoughts before the answer."""

import json
from dataclasses import replace

import pytest
from asked import Reasoned, allowed, pairs, reasoned, sensible
from worlds import Car, Junction, car

from codriving.datatypes.world import Action
from codriving.llm.question import Question
from codriving.reasoning.decision.rules import RuleDecider

THREE = (
    car("CAV1", "south-north", 60, 8, 9),
    car("CAV2", "west-east", 62, 8, 9),
    car("CAV3", "east-south", 62, 8, 9),
)
HUMAN = car("HDV1", "east-south", 76, 8)
NEAR = car("CAV1", "south-north", 78, 8, 9)


def says(**said: str) -> str:
    return json.dumps({"reason": "It is wise.", "action": "SLOWER", **said})


def planning(question: Question) -> str:
    """Negotiates sensibly, and decides with a plan."""
    return sensible(question) if question.purpose == "negotiate" else says(plan="Go after CAV2.")


def decisions(made: Reasoned) -> list[Question]:
    return [q for q in made.chat.questions if q.purpose == "decide"]


def at(junction: Junction, made: Reasoned, *cars: Car, time: float = 0.0) -> list[Question]:
    """What is asked for decisions at one more moment."""
    before = len(decisions(made))
    made.method.act(junction.world(*cars, time=time, step=round(2 * time)))
    return decisions(made)[before:]


def test_where_there_is_nothing_to_judge_the_rules_drive_and_are_counted(junction: Junction) -> None:
    worlds = ((car("CAV3", "west-east", 45, 9), car("CAV1", "south-north", 20, 8)), THREE, (NEAR, HUMAN))
    asked = 0
    for cars in worlds:
        made, other = (reasoned(junction, planning, prompts=name) for name in ("informed", "planner"))
        done = made.method.act(junction.world(*cars))
        known = {q.subject for q in decisions(made)}
        rules = {d.ego: d.action for d in RuleDecider().decide(done.situations)}
        for decision in done.decisions:
            assert decision.action is (Action.SLOWER if decision.ego in known else rules[decision.ego])
        unasked = done.counts.get("plain_decisions", 0) + done.counts["single_decisions"]
        assert unasked == len(done.decisions) - len(known)
        other.method.act(junction.world(*cars))
        assert known <= {q.subject for q in decisions(other)}
        asked += len(known)
    assert asked


@pytest.mark.parametrize(("prompts", "named"), [("informed", "CAV1_CAV2"), ("planner", "p1")])
def test_name_of_a_pair_lasts(junction: Junction, prompts: str, named: str) -> None:
    made = reasoned(junction, planning, prompts=prompts)
    made.method.act(junction.world(*THREE))
    [question] = [q for q in made.chat.questions if q.purpose == "negotiate"]
    assert set(pairs(question)[named]) == ({"CAV1", "CAV2"} if prompts == "informed" else set(pairs(question)["p1"]))
    assert len(pairs(question)) == 3


def test_humans_and_waiting_are_told_where_an_order_is_asked_for(junction: Junction) -> None:
    made = reasoned(junction, planning, prompts="informed")
    made.method.act(junction.world(*THREE, HUMAN))
    [question] = [q for q in made.chat.questions if q.purpose == "negotiate"]
    text = question.messages[1].content
    assert "- HDV1 (human), 8.0 m/s:" in text
    assert "CAV1 first: CAV2 waits" in text
    assert "rule: turning yields" in text
    assert "rule: never in a circle" in text
    made.method.act(junction.world(*THREE[:2]))
    assert "rule: turning" not in made.chat.questions[-1].messages[1].content


def test_what_was_decided_is_told_with_the_plan_and_what_has_changed(junction: Junction) -> None:
    made = reasoned(junction, planning, prompts="informed", ask_plain=True)
    [first] = at(junction, made, NEAR, HUMAN)
    assert "decision ago" not in first.messages[1].content
    [then] = at(junction, made, replace(NEAR, place=82), replace(HUMAN, place=79, speed=5), time=0.5)
    text = then.messages[1].content
    assert "- 1 decision ago you took SLOWER (It is wise.); plan: Go after CAV2.; since then: HDV1 slowed down" in text
    assert "from 8.0 to 5.0 m/s" in text


def test_last_second_of_a_human_driver_is_told(junction: Junction) -> None:
    made = reasoned(junction, planning, prompts="informed", ask_plain=True)
    for k in range(3):
        [question] = at(junction, made, NEAR, replace(HUMAN, place=76 + 2 * k, speed=8 - k), time=k / 2)
    text = question.messages[1].content
    assert "HDV1: 6.0 m/s, 8.0 m/s a second ago" in text
    assert "to stop before the zone it has to brake with" in text


def test_no_metres_are_told_of_an_action(junction: Junction) -> None:
    made = reasoned(junction, planning, prompts="informed", ask_plain=True)
    made.method.act(junction.world(*THREE, HUMAN))
    for question in decisions(made):
        lines = [line for line in question.messages[1].content.splitlines() if line.startswith("- SLOWER")]
        assert lines
        assert not [line for line in lines if " m," in line or line.endswith(" m") or "gets" in line]


@pytest.mark.parametrize("prompts", ["informed", "planner"])
def test_thoughts_come_before_the_answer_and_stay_in_the_transcript(junction: Junction, prompts: str) -> None:
    def thoughtful(question: Question) -> str:
        thoughts = "States. " * 200
        if question.purpose == "negotiate":
            return json.dumps({"thoughts": thoughts, **{name: two[0] for name, two in pairs(question).items()}})
        return json.dumps({"thoughts": thoughts, "reason": "so", "action": allowed(question)[0]})

    made = reasoned(junction, thoughtful, prompts=prompts, thoughts=True, ask_plain=True)
    done = made.method.act(junction.world(*THREE))
    assert {line["purpose"] for line in done.transcript} == {"negotiate", "decide"}
    for question, line in zip(made.chat.questions, done.transcript, strict=True):
        assert next(iter(question.schema.model_json_schema()["properties"])) == "thoughts"
        assert '"thoughts"' in question.messages[0].content
        assert len(line["value"]["thoughts"]) == 600
        assert question.more_tokens >= 250
    silent = reasoned(junction, planning, prompts=prompts, ask_plain=True)
    silent.method.act(junction.world(*THREE))
    assert not [q for q in silent.chat.questions if "thoughts" in q.messages[0].content]


@pytest.mark.parametrize("prompts", ["informed", "planner"])
def test_tables_name_the_prompts(junction: Junction, prompts: str) -> None:
    assert reasoned(junction, sensible, prompts=prompts).method.reasoner == f"scripted ({prompts})"
