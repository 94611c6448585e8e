"""Questions are asked as where a model drives, of rules, controls and of one who answers elsewhere."""

import json
from dataclasses import replace

import pytest
from small_exam import small_exam

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.parts import Model, RuleModel
from codriving.datatypes.world import Action
from codriving.errors import ModelError
from codriving.exam.sitting import as_said, sit, some, wording
from codriving.llm.language_model import LanguageModel
from codriving.reasoning import RuleDecider

EXAM = small_exam()


def control(name: str) -> Model:
    return build(compose([f"llm={name}"])["llm"], Model, "llm")


def test_the_rules_decide_and_order_as_they_do() -> None:
    found = sit(some(EXAM, None), RuleModel())
    assert [one.action for one in found[: len(EXAM.situations)]] == [
        RuleDecider().decide([one.situation])[0].action for one in EXAM.situations
    ]
    assert [dict(one.first) for one in found[len(EXAM.situations) :]] == [
        {(p.one, p.other): p.first for p in one.pairs} for one in EXAM.negotiations
    ]
    assert all(one.lines == () for one in found)


def test_a_control_is_asked_and_answers_alike_each_time() -> None:
    questions = some(EXAM, None)
    first = sit(questions, control("first"))
    for one in first[: len(EXAM.situations)]:
        allowed = one.asked.situation.allowed  # type: ignore[union-attr]
        assert one.action == (Action.FASTER if Action.FASTER in allowed else Action.IDLE)
    for one in first[len(EXAM.situations) :]:
        assert list(one.first.values()) == [pair.one for pair in one.asked.pairs]  # type: ignore[union-attr]
    again = sit(questions, control("random")), sit(questions, control("random"))
    assert [one.decided for one in again[0]] == [one.decided for one in again[1]]
    assert [one.decided for one in again[0]] != [one.decided for one in first]


def test_who_is_asked_elsewhere_is_read_alike() -> None:
    situation = next(one for one in EXAM.situations if one.contests)
    decide, judge = wording(situation)
    assert (decide.purpose, judge.purpose) == ("decide", "judge")
    assert [message.role for message in decide.messages] == ["system", "user"]
    last = situation.situation.allowed[-1]
    pairs = dict.fromkeys(judge.schema.pairs, 0.9)  # type: ignore[attr-defined]
    said = {"decide": f'I say {{"reason": "x", "action": "{last}"}}', "judge": json.dumps(pairs)}
    read = as_said(situation, said)
    assert (read.action, read.yields) == (last, (True,) * len(situation.contests))
    nothing = as_said(situation, {"decide": "what?"})
    assert (nothing.action, nothing.yields) == (None, (None,) * len(situation.contests))
    [order] = wording(EXAM.negotiations[0])
    assert order.purpose == "negotiate"


def test_some_are_taken_evenly() -> None:
    everything = some(EXAM, None)
    assert some(EXAM, 10_000) == everything
    assert some(EXAM, 1) == everything[:1]
    half = some(EXAM, len(everything) // 2)
    assert len(half) == len(everything) // 2
    assert half[-1] in everything[-3:]


def test_a_model_that_says_nothing_of_use_is_not_asked_on(monkeypatch: pytest.MonkeyPatch) -> None:
    silent = control("first")
    assert isinstance(silent, LanguageModel)
    silent = replace(silent, max_concurrency=1, epoch=7)
    from codriving.llm.controls import FormSender
    from codriving.llm.request import Reply

    async def send(*_: object, **__: object) -> Reply:
        return Reply("nothing", "stop", prompt_tokens=1, completion_tokens=1)

    monkeypatch.setattr(FormSender, "send", send)
    with pytest.raises(ModelError, match="no usable answer to any of the first 2 questions"):
        sit(EXAM.situations[:3], silent, patience=2)
