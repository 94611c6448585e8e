"""How an answer is asked for, and what is remembered about it."""

import json
from typing import Literal

from pydantic import BaseModel

from codriving.llm.question import Message
from codriving.llm.request import FORMS, Forms, response_format, schema_of, worded


class Pair(BaseModel):
    """One part of an answer, with a field called like a keyword of JSON schema."""

    first: str
    title: str = "none"


class Orders(BaseModel):
    """Not for the model."""

    orders: list[Pair]
    action: Literal["IDLE", "SLOWER"]


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


def test_without_a_schema_nothing_is_added() -> None:
    for form in FORMS:
        assert response_format(form, None) is None
        assert worded(TALK, form, None) == TALK


def test_step_down_is_remembered_once_per_model() -> None:
    forms = Forms()
    assert forms.step_down("a", None, "json_schema")
    assert forms.step_down("a", None, "json_schema"), "a question that was on its way when the first one was refused"
    assert forms.best("a", None) == "json_object"
    assert forms.best("b", None) == forms.best("a", "http://elsewhere/v1") == "json_schema"
    assert forms.step_down("a", None, "json_object")
    assert not forms.step_down("a", None, "text")
    assert forms.best("a", None) == "text"
