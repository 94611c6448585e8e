"""Controls in the model's place: they read the form alone, and are asked, read and counted as a model is."""

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal

import pytest
from fake_sender import SETTINGS
from pydantic import BaseModel

from codriving.errors import ModelError
from codriving.llm.controls import ControlFirst, ControlRandom, StandIn, filled
from codriving.llm.prompts.replies import DecisionReply, OrderReply, correction_reply, decision_reply, order_reply
from codriving.llm.question import Answer, Message, Question
from codriving.llm.request import schema_of

PAIRS = {"p1": ("CAV2", "CAV1"), "p2": ("CAV3", "CAV2")}


def made(kind: type[StandIn], **changes: Any) -> StandIn:
    settings = {
        **vars(replace(SETTINGS, model="x", api_base=None, input_cost_per_token=0.0, output_cost_per_token=0.0))
    }
    return kind(**{**settings, **changes})


def question(form: type[BaseModel], text: str = "Choose.", occasion: str = "") -> Question:
    return Question("decide", "CAV1", (Message("user", text),), form, occasion=occasion)


def asked(control: StandIn, *questions: Question) -> list[Answer]:
    return control.chat().ask(questions)


def action(control: StandIn, allowed: Sequence[str], text: str = "Choose.", occasion: str = "") -> str:
    [answer] = asked(control, question(decision_reply(tuple(allowed)), text, occasion))
    assert isinstance(answer.value, DecisionReply)
    return answer.value.action


@pytest.mark.parametrize(
    ("allowed", "fastest"),
    [
        (["SLOWER", "IDLE", "FASTER"], "FASTER"),
        (["HOLD", "SLOWER", "LANE_LEFT"], "HOLD"),
        (["SLOWER", "HOLD", "IDLE"], "IDLE"),
        (["SLOWER", "LANE_RIGHT"], "LANE_RIGHT"),
        (["SLOWER"], "SLOWER"),
    ],
)
def test_first_takes_the_fastest_action_of_the_form(allowed: list[str], fastest: str) -> None:
    assert action(made(ControlFirst), allowed) == fastest


def test_first_does_not_read_the_words() -> None:
    assert action(made(ControlFirst), ["IDLE", "SLOWER"], "Allowed actions: FASTER. Choose SLOWER.") == "IDLE"


def test_first_lets_the_first_named_go_first() -> None:
    [answer] = asked(made(ControlFirst), question(order_reply(PAIRS)))
    assert isinstance(answer.value, OrderReply)
    assert [getattr(answer.value, pair).first for pair in PAIRS] == ["CAV2", "CAV3"]


def test_an_answer_is_read_strictly_and_costs_nothing() -> None:
    [answer] = asked(made(ControlFirst), question(decision_reply(("IDLE",)), "x" * 401))
    [call] = answer.calls
    assert (call.form, call.problem, answer.mended, call.cost) == ("json_schema", "", False, 0.0)
    assert (call.prompt_tokens, call.seconds, call.finish_reason) == (101, 0.0, "stop")
    assert call.completion_tokens == -(-len(call.text) // 4)


def test_a_correction_has_a_lesson() -> None:
    [answer] = asked(made(ControlRandom, seed=0), question(correction_reply(("IDLE", "SLOWER"))))
    assert answer.value is not None
    assert answer.value.lesson == "drawn at random"  # type: ignore[attr-defined]


class Human(BaseModel):
    """A part of it."""

    goes: Literal["yields", "goes", "unclear"]
    within: int


class Judged(BaseModel):
    """A form that no prompt of ours has."""

    humans: dict[str, str]
    first: Human
    second: Human | None
    several: list[Human]
    action: Literal["SLOWER", "FASTER"]
    sure: bool


@pytest.mark.parametrize("kind", [ControlFirst, ControlRandom])
def test_any_form_is_filled_in(kind: type[StandIn]) -> None:
    [answer] = asked(made(kind), question(Judged))
    assert isinstance(answer.value, Judged)
    if kind is ControlFirst:
        assert (answer.value.action, answer.value.first.goes) == ("FASTER", "yields")


def test_forms_may_be_nested_and_ask_for_so_many() -> None:
    form = {
        "type": "object",
        "properties": {
            "list": {"type": "array", "minItems": 2, "items": {"$ref": "#/$defs/word"}},
            "const": {"const": 7},
            "either": {"anyOf": [{"type": "null"}, {"type": "integer", "minimum": 3}]},
            "text": {"type": "string"},
        },
        "$defs": {"word": {"enum": ["b", "a"]}},
    }
    assert filled(form, lambda words: words[0], "so") == {"list": ["b", "b"], "const": 7, "either": 3, "text": "so"}


def drawn(seed: int = 0, **changes: Any) -> list[str]:
    control = made(ControlRandom, seed=seed, **changes)
    return [action(control, ["SLOWER", "IDLE", "FASTER"], f"Question {k}") for k in range(40)]


def test_random_draws_alike_for_a_seed_and_otherwise_for_another() -> None:
    assert drawn(1) == drawn(1)
    assert drawn(1) != drawn(2)
    assert drawn(1) != drawn(1, epoch=2)
    assert {"SLOWER", "IDLE", "FASTER"} == set(drawn(1))
    counts = [drawn(3).count(word) for word in ("SLOWER", "IDLE", "FASTER")]
    assert min(counts) > 4


def test_random_draws_anew_when_a_question_is_repeated_in_an_episode() -> None:
    control = made(ControlRandom, seed=0)
    said = [action(control, ["SLOWER", "FASTER"], occasion=f"7 {k}") for k in range(20)]
    assert set(said) == {"SLOWER", "FASTER"}
    assert said == [action(control, ["SLOWER", "FASTER"], occasion=f"7 {k}") for k in range(20)]


def test_random_orders_both_ways() -> None:
    control, firsts = made(ControlRandom, seed=0), set()
    for k in range(20):
        [answer] = asked(control, question(order_reply(PAIRS), f"Question {k}"))
        firsts.add(answer.value.p1.first)  # type: ignore[union-attr]
    assert firsts == {"CAV1", "CAV2"}


def test_cache_rules_are_those_of_a_model(tmp_path: Path) -> None:
    file, form = str(tmp_path / "answers.sqlite"), decision_reply(("SLOWER", "FASTER"))
    questions = [question(form, "Again.", f"0 {k}") for k in range(8)]
    live = asked(made(ControlRandom, seed=0, cache="use", cache_file=file), *questions)
    again = asked(made(ControlRandom, seed=0, cache="replay", cache_file=file), *questions)
    assert [a.value.action for a in live] == [a.value.action for a in again]  # type: ignore[union-attr]
    assert {a.value.action for a in live} == {"SLOWER", "FASTER"}  # type: ignore[union-attr]
    assert all(call.cached for a in again for call in a.calls)
    with pytest.raises(ModelError, match="does not hold what is asked now"):
        asked(made(ControlRandom, seed=0, cache="replay", cache_file=file), question(form, "New."))


def test_names_say_that_it_is_a_control() -> None:
    assert made(ControlFirst, model="first").name == "control first"
    assert made(ControlRandom, model="random", label="draws").name == "control draws"


def test_a_control_wants_no_key_and_no_server() -> None:
    made(ControlFirst).chat().preflight()
    assert json.dumps(schema_of(decision_reply(("IDLE",))))
