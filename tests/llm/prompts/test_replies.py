"""The forms of the answers: what they ask for, and what they put up with."""

import json

import pytest
from pydantic import ValidationError

from codriving.llm.prompts.replies import decision_reply, first_of_pairs, order_reply
from codriving.llm.request import schema_of

PAIRS = {"p1": ("CAV1", "CAV2"), "p2": ("CAV2", "CAV3")}


def order(*said: tuple[str, str]) -> dict[str, tuple[str, str]]:
    text = json.dumps({"orders": [{"pair": pair, "first": first, "reason": "so"} for pair, first in said]})
    return first_of_pairs(order_reply(PAIRS).model_validate_json(text))


def test_decision_asks_for_the_allowed_actions_and_a_reason_first() -> None:
    properties = schema_of(decision_reply(("SLOWER", "IDLE")))["properties"]
    assert list(properties) == ["reason", "action"]
    assert properties["action"] == {"enum": ["SLOWER", "IDLE"], "type": "string"}


def test_order_asks_for_the_pairs_and_the_vehicles() -> None:
    schema = schema_of(order_reply(PAIRS))
    assert list(schema["properties"]) == schema["required"] == ["reason", "p1", "p2"]
    assert schema["properties"]["p1"] == {"enum": ["CAV1", "CAV2"], "type": "string"}
    assert schema["properties"]["p2"] == {"enum": ["CAV2", "CAV3"], "type": "string"}
    assert schema["additionalProperties"] is False


def test_reason_of_all_pairs_is_the_reason_of_each_that_has_none() -> None:
    said = {"reason": "nearer", "p1": "CAV1", "p2": {"first": "CAV3", "reason": "cannot stop"}}
    assert first_of_pairs(order_reply(PAIRS).model_validate(said)) == {
        "p1": ("CAV1", "nearer"),
        "p2": ("CAV3", "cannot stop"),
    }


def test_decision_puts_up_with_case_and_long_reasons() -> None:
    said = decision_reply(("IDLE",)).model_validate({"action": " idle\n", "reason": "a\n\x1b[31m" + "b" * 5000})
    assert said.action == "IDLE"
    assert said.reason.startswith("a [31mb")
    assert len(said.reason) == 160


@pytest.mark.parametrize("said", [{}, {"action": None}, {"action": 3}, {"action": ["IDLE"]}])
def test_decision_without_an_action_is_none(said: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        decision_reply(("IDLE",)).model_validate(said)


def test_reason_may_be_missing() -> None:
    assert decision_reply(("IDLE",)).model_validate({"action": "IDLE", "reason": None}).reason == ""
    assert decision_reply(("IDLE",)).model_validate({"action": "IDLE"}).reason == ""


@pytest.mark.parametrize(
    ("said", "kept"),
    [
        ([("p1", "CAV1"), ("p2", "CAV3")], {"p1": "CAV1", "p2": "CAV3"}),
        ([("p1", " CAV2 ")], {"p1": "CAV2"}),
        ([("p1", "CAV3"), ("p2", "CAV3")], {"p2": "CAV3"}),
        ([("p1", "HDV9"), ("p7", "CAV1"), ("p2", "CAV2")], {"p2": "CAV2"}),
        ([("p1", "CAV1"), ("p1", "CAV1")], {"p1": "CAV1"}),
        ([("p1", "CAV1"), ("p1", "CAV2"), ("p2", "CAV2")], {"p2": "CAV2"}),
        ([], {}),
    ],
    ids=["all", "blanks", "not of the pair", "unknown ids", "twice alike", "twice unlike", "nothing"],
)
def test_what_can_be_used_of_an_order(said: list[tuple[str, str]], kept: dict[str, str]) -> None:
    assert {name: first for name, (first, _) in order(*said).items()} == kept
