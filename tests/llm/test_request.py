"""How an answer is asked for, and what is remembered about it."""

import json
from dataclasses import replace
from typing import Literal

from pydantic import BaseModel

from codriving.llm.prompts.replies import LessonReply, correction_reply, decision_reply, order_reply
from codriving.llm.question import Message
from codriving.llm.request import FORMS, ChatRequest, Forms, plainer, response_format, schema_of, spoken, worded


class Pair(BaseModel):
    """One part of an answer, with a field called like a keyword of JSON schema."""

    first: str
    title: str = "none"


class Orders(BaseModel):
    """Not for the model."""

    orders: list[Pair]
    action: Literal["IDLE", "SLOWER"]


PAIRS = {f"p{k}": ("CAV1", f"CAV{k + 1}") for k in range(1, 25)}
SCHEMA = schema_of(Orders)
TALK = (Message("system", "You drive."), Message("user", "Choose."))


def test_schema_is_strict_all_the_way_down() -> None:
    assert SCHEMA["required"] == ["orders", "action"]
    assert SCHEMA["additionalProperties"] is False
    pair = SCHEMA["$defs"]["Pair"]
    assert pair["required"] == ["first", "title"]
    assert pair["additionalProperties"] is False
    assert "default" not in pair["properties"]["title"]
    assert SCHEMA["properties"]["action"]["enum"] == ["IDLE", "SLOWER"]


def test_each_form_says_the_schema_once() -> None:
    asked = response_format("json_schema", SCHEMA)
    assert asked is not None
    assert asked["json_schema"]["schema"] == SCHEMA
    assert worded(TALK, "json_schema", SCHEMA) == TALK
    assert response_format("json_object", SCHEMA) == {"type": "json_object"}
    assert response_format("text", SCHEMA) is None
    for form in ("json_object", "text"):
        told = worded(TALK, form, SCHEMA)
        assert told[0] == TALK[0]
        assert json.loads(told[1].content.splitlines()[-1]) == SCHEMA


def test_lengths_go_first() -> None:
    decision = schema_of(decision_reply(("IDLE",)))
    bounded, free = (response_format(form, decision) for form in FORMS[:2])
    assert bounded is not None
    assert free is not None
    assert bounded["json_schema"]["schema"]["properties"]["reason"] == {"type": "string", "maxLength": 240}
    assert free["json_schema"]["schema"]["properties"]["reason"] == {"type": "string"}
    assert free["json_schema"]["schema"]["required"] == ["reason", "action"]
    assert worded(TALK, "json_schema_any_length", decision) == TALK
    named = {"properties": {"maxLength": {"type": "string", "maxLength": 3}}}
    asked = response_format("json_schema_any_length", named)
    assert asked is not None
    assert asked["json_schema"]["schema"] == {"properties": {"maxLength": {"type": "string"}}}


def test_a_form_leaves_no_way_to_run_on() -> None:
    forms = (decision_reply(("IDLE", "SLOWER")), correction_reply(("IDLE",)), order_reply(PAIRS), LessonReply)
    for schema in map(schema_of, forms):
        assert schema["additionalProperties"] is False
        assert all("enum" in node or node["maxLength"] == 240 for node in schema["properties"].values())


def test_without_a_schema_nothing_is_added() -> None:
    for form in FORMS:
        assert response_format(form, None) is None
        assert worded(TALK, form, None) == TALK


def asked(model: str = "a", api_base: str | None = None) -> ChatRequest:
    return ChatRequest(model, api_base, TALK, 0.0, 300, SCHEMA)


def test_what_works_is_remembered_once_per_model() -> None:
    forms = Forms()
    assert not forms.settle(asked(), "json_object", ())
    assert forms.best(asked()) == ("json_object", ())
    assert forms.best(asked("b")) == forms.best(asked("a", "http://elsewhere/v1")) == ("json_schema", ())
    forms.settle(asked(), "text", ())
    assert forms.best(asked()) == ("json_object", ()), "one refusal of what has worked says nothing about the form"
    assert forms.settle(asked("b"), "text", ("temperature",))
    assert forms.best(asked("b")) == ("text", ("temperature",))


def test_plainer_ways_go_from_one_field_to_all() -> None:
    assert list(plainer("json_schema", (), True, False, "")) == [
        ("json_schema_any_length", ()),
        ("json_object", ()),
        ("text", ()),
        ("text", ("temperature", "any limit")),
    ]
    ways = [left_out for _, left_out in plainer("text", (), False, True, "Unsupported parameter: temperature")]
    assert ways == [
        ("temperature",),
        ("max_tokens",),
        ("system",),
        ("temperature", "max_tokens"),
        ("temperature", "system"),
        ("max_tokens", "system"),
        ("temperature", "max_tokens", "system"),
        ("temperature", "any limit", "system"),
    ]


def test_what_is_left_out_changes_the_request_and_nothing_else() -> None:
    request = asked()
    assert request.without(("temperature",)) == replace(request, temperature=None)
    assert request.without(("max_tokens", "system")) == replace(
        request, max_tokens_field="max_completion_tokens", system_role="user"
    )
    assert request.without(("any limit",)).max_tokens_field is None


def test_what_an_answer_depends_on_holds_only_what_is_set() -> None:
    request = asked()
    plain = ["api_base", "max_tokens", "messages", "model", "schema", "temperature"]
    assert sorted(request.told()) == sorted(replace(request, stream=True).told()) == plain
    assert replace(request, extra={"think": False}).told()["extra"] == {"think": False}


def test_instructions_go_into_the_role_that_a_server_knows() -> None:
    assert spoken(TALK, "system") == TALK
    assert spoken(TALK, "developer") == (Message("developer", "You drive."), TALK[1])
    assert spoken(TALK, "user") == (Message("user", "You drive.\n\nChoose."),)
