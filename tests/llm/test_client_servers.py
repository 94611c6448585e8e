"""Servers that want something else than most, or give less: what they are sent, and what is made of it, over HTTP."""

import json
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from fake_sender import SETTINGS, Choice, Waits
from faults import FAULTS, Fault
from loopback import Loopback, Request

from codriving.errors import ModelError, ModelUnavailableError, SpendingLimitError
from codriving.llm.client import ModelChat
from codriving.llm.ledger import Ledger
from codriving.llm.question import Answer, Message, Question
from codriving.llm.request import Forms

KEY = "sk-canary-0123456789abcdef"
QUESTION = Question(
    "decide", "cav_0", (Message("system", "You drive."), Message("user", "Allowed actions: IDLE, SLOWER\n")), Choice
)


@pytest.fixture(autouse=True)
def key(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CANARY_KEY", KEY)
    monkeypatch.setenv("NO_PROXY", "127.0.0.1")


def client(server: Loopback, **changes: Any) -> ModelChat:
    settings = {"model": "openai/m", "api_base": server.url, "attempts": 2, "deadline": 20.0, **changes}
    return ModelChat(replace(SETTINGS, **settings), sleep=Waits(), forms=Forms())


def ask(asked: ModelChat) -> Answer:
    (answer,) = asked.ask([QUESTION])
    assert isinstance(answer, Answer)
    return answer


def refuses(
    has: Callable[[Request], object], status: int, said: str = "不支持该参数"
) -> Callable[[Request], Fault | None]:
    """A server that refuses what has something, in its own language."""
    return lambda request: Fault(status=status, error=said, code="") if has(request) else None


@pytest.mark.parametrize("status", [400, 402, 403, 404, 405, 406, 409, 415, 422, 500, 501])
@pytest.mark.parametrize("said", ["不支持该参数", "No endpoints found", "Format de réponse inconnu"])
def test_a_form_that_is_refused_is_left_out_whatever_status_and_language(
    loopback: Loopback, status: int, said: str
) -> None:
    asked = client(loopback)
    asked.preflight()
    loopback.plan = refuses(lambda request: "response_format" in request.body, status, said)
    assert ask(asked).calls[0].form == "text"
    loopback.requests.clear()
    assert ask(asked).calls[0].attempts == len(loopback.requests) == 1, "what works is remembered"


HAS: dict[str, Callable[[Request], object]] = {
    "temperature": lambda request: "temperature" in request.body,
    "max_tokens": lambda request: "max_tokens" in request.body,
    "any limit": lambda request: {"max_tokens", "max_completion_tokens"} & request.body.keys(),
    "system": lambda request: any(message["role"] == "system" for message in request.messages),
}


@pytest.mark.parametrize("status", [400, 404, 422, 501])
@pytest.mark.parametrize(
    "fields", [("temperature",), ("max_tokens",), ("system",), ("temperature", "max_tokens"), ("any limit", "system")]
)
def test_fields_that_are_refused_are_found_by_trying(loopback: Loopback, fields: tuple[str, ...], status: int) -> None:
    asked, notes = client(loopback), list[str]()
    asked.on_note = notes.append
    loopback.plan = refuses(lambda request: any(HAS[name](request) for name in fields), status)
    asked.preflight()
    loopback.requests.clear()
    assert ask(asked).value is not None
    (sent,) = loopback.requests
    assert not any(HAS[name](sent) for name in fields)
    assert ("max_completion_tokens" in sent.body) == ("max_tokens" in fields)
    assert "You drive." in str(sent.messages)
    assert len(notes) == 1
    assert notes[0].startswith("openai/m: the server refuses ")
    for name, cure in {"temperature": "llm.temperature=null", "system": "llm.system_role=user"}.items():
        assert (cure in notes[0]) == (name in fields or "any limit" in fields)


def test_what_the_server_names_is_left_out_first(loopback: Loopback) -> None:
    loopback.plan = refuses(HAS["system"], 400, "role 'system' is not one of user, assistant")
    client(loopback).preflight()
    assert len(loopback.requests) == 2


def test_answer_that_does_not_fit_the_form_is_asked_for_plainly_once(loopback: Loopback) -> None:
    asked = client(loopback)
    assert ask(asked).calls[0].form == "json_schema"
    fault = Fault(status=400, error="Failed to generate JSON", code="json_validate_failed")
    loopback.restart_plan([fault])
    answer = ask(asked)
    assert answer.value is not None
    assert (answer.calls[0].form, answer.calls[0].attempts) == ("json_schema_any_length", 2)
    assert ask(asked).calls[0].form == "json_schema", "the form has worked before"


@pytest.mark.parametrize("text", ["", "<think>Perhaps SLOWER, for", "<thinking>\nLet me see"])
def test_a_model_that_thinks_until_its_tokens_are_used_up_is_not_asked_again(loopback: Loopback, text: str) -> None:
    cut = FAULTS["cut_off"]
    asked, notes = client(loopback, fallbacks_at_first=3), list[str]()
    asked.on_note = notes.append
    asked.preflight()
    loopback.plan = lambda request: replace(cut, write=lambda content: text)
    loopback.requests.clear()
    for _ in range(2):
        answer = ask(asked)
        assert answer.value is None
        assert "keep it shorter" not in answer.problem
    assert len(loopback.requests) == 2
    assert len(notes) == 1
    assert "(llm.max_tokens=300); raise llm.max_tokens, or switch thinking off" in notes[0]
    with pytest.raises(
        ModelError, match=r"no usable answer to the first 3 questions .*; raise llm\.max_tokens"
    ) as stop:
        ask(asked)
    assert "\n" not in str(stop.value)


@pytest.mark.parametrize(
    ("choice", "value"),
    [
        ({"text": '{"reason": "free", "action": "IDLE"}'}, "IDLE"),
        ({"message": None, "text": '{"reason": "free", "action": "IDLE"}'}, "IDLE"),
        ({"message": '{"reason": "free", "action": "IDLE"}'}, "IDLE"),
        ({"message": None}, None),
        ({"finish_reason": "stop"}, None),
    ],
)
def test_a_choice_without_a_message_is_read_or_no_answer(loopback: Loopback, choice: object, value: str | None) -> None:
    asked = client(loopback)
    asked.preflight()
    loopback.plan = lambda request: Fault(wrap=lambda body: {**body, "choices": [choice]})
    answer = ask(asked)
    assert (answer.value and answer.value.action) == value  # type: ignore[attr-defined]
    assert "Traceback" not in answer.problem


@pytest.mark.parametrize("name", ["empty_content", "unknown_action", "html", "filtered"])
def test_a_model_that_never_answers_stops_the_batch(loopback: Loopback, name: str) -> None:
    loopback.plan = lambda request: FAULTS[name]
    asked = client(loopback, fallbacks_at_first=4)
    asked.ask([QUESTION] * 3)
    with pytest.raises(ModelError, match=r"first 4 questions \(llm\.fallbacks_at_first\), .*codriving check"):
        ask(asked)


def test_a_model_that_has_answered_once_may_fall_back(loopback: Loopback) -> None:
    asked = client(loopback, fallbacks_at_first=2)
    ask(asked)
    loopback.plan = lambda request: FAULTS["empty_content"]
    assert [answer.value for answer in asked.ask([QUESTION] * 5)] == [None] * 5


@pytest.mark.parametrize(
    "usage", [None, {}, [], "none", {"prompt_tokens": 0, "completion_tokens": 0}, {"prompt_tokens": "many"}]
)
def test_tokens_that_the_server_does_not_count_are_estimated(loopback: Loopback, usage: object) -> None:
    loopback.plan = lambda request: Fault(wrap=lambda body: {**body, "usage": usage})
    asked, notes = client(loopback), list[str]()
    asked.on_note = notes.append
    (call,) = ask(asked).calls
    # 10 and 30 bytes of the question; the answer has between 40 and 200.
    assert call.prompt_tokens == 10
    assert 10 <= call.completion_tokens <= 50
    assert notes == ["openai/m: the server counts no tokens; they are estimated, 4 bytes each"]
    assert call.cost == pytest.approx(10 * 1e-6 + call.completion_tokens * 2e-6)


def test_limits_hold_without_a_count(loopback: Loopback) -> None:
    loopback.plan = lambda request: Fault(wrap=lambda body: {k: v for k, v in body.items() if k != "usage"})
    for limit in ({"max_tokens_total": 50}, {"max_cost": 6e-5}):
        asked = client(loopback, **limit)
        asked.ask([QUESTION] * 3)
        with pytest.raises(SpendingLimitError):
            ask(asked)


def test_time_outs_lower_the_number_at_once_and_say_the_times(loopback: Loopback) -> None:
    asked = client(loopback, deadline=0.3, attempts=9, max_concurrency=8)
    asked.preflight()

    def one_slot(request: Request) -> Fault:
        """Works off one request after the other, each in a tenth of a second."""
        return Fault(latency=0.1 * loopback.in_flight)

    loopback.plan = one_slot
    told: list[str] = []
    asked.on_retry = lambda retry: told.append(str(retry))
    assert all(answer.value is not None for answer in asked.ask([QUESTION] * 12))
    loopback.high_water = 0
    asked.ask([QUESTION] * 6)
    assert loopback.high_water <= 4
    assert "did not answer in time (0.3 s; " in told[0]
    loopback.plan = lambda request: FAULTS["timeout"]
    line = r"did not answer in time \(0\.3 s; answers took \d\.\d to \d\.\d s, now \d at once\), asked 2 times; raise"
    slow = client(loopback, deadline=0.3)
    loopback.plan = ()
    slow.preflight()
    loopback.plan = lambda request: FAULTS["timeout"]
    with pytest.raises(ModelUnavailableError, match=line):
        ask(slow)


def test_extra_fields_and_headers_are_sent_as_they_are(loopback: Loopback) -> None:
    extra = {"reasoning_effort": "low", "seed": 7, "options": {"num_ctx": 8192}, "temperature": None}
    asked = client(loopback, extra=extra, headers={"X-Team": "roads"}, max_tokens_field="max_completion_tokens")
    assert ask(asked).value is not None
    (sent,) = loopback.requests
    assert {name: sent.body.get(name) for name in extra} == extra
    assert "temperature" not in sent.body
    assert (sent.headers["x-team"], sent.body["max_completion_tokens"]) == ("roads", 300)
    assert "max_tokens" not in sent.body


@pytest.mark.parametrize("model", ["openai/m", "hosted_vllm/m"])
def test_roles_limits_and_streams_are_as_the_config_says(loopback: Loopback, model: str) -> None:
    loopback.plan = lambda request: None if request.body.get("stream") else Fault(status=400, error="nur stream")
    asked = client(loopback, model=model, stream=True, system_role="user", max_tokens_field=None)
    asked.preflight()
    loopback.requests.clear()
    answer = ask(asked)
    assert answer.value is not None
    (sent,) = loopback.requests
    assert [message["role"] for message in sent.messages] == ["user"]
    assert not {"max_tokens", "max_completion_tokens"} & sent.body.keys()
    assert answer.calls[0].prompt_tokens > 0 < answer.calls[0].completion_tokens


def test_a_server_that_always_streams_is_understood_and_one_that_breaks_off_asked_again(loopback: Loopback) -> None:
    def event(content: str) -> str:
        return f"data: {json.dumps({'choices': [{'delta': {'content': content}}]})}\n\n"

    half = Fault(headers={"Content-Type": "text/event-stream"}, pack=lambda _: event("{").encode())
    words = ": a comment\n" + event('{"reason": "free", ') + event('"action": "IDLE"}') + "data: [DONE]\n\n"
    whole = replace(half, pack=lambda _: words.encode())
    error = replace(half, pack=lambda _: b'data: {"error": {"message": "slow down", "code": 429}}\n\n')
    loopback.plan = [half, error, whole]
    asked = client(loopback, attempts=3)
    answer = ask(asked)
    assert answer.calls[0].attempts == 3
    assert answer.value == Choice(reason="free", action="IDLE")


def test_a_server_that_only_streams_names_the_setting(loopback: Loopback) -> None:
    loopback.plan = lambda request: Fault(status=400, error="this endpoint only supports stream=true")
    with pytest.raises(ModelError, match=r"set llm\.stream=true"):
        client(loopback).preflight()


def test_a_key_may_have_a_header_of_its_own(loopback: Loopback) -> None:
    ask(client(loopback, api_key_env="CANARY_KEY", api_key_header="X-Gateway-Key"))
    headers = loopback.requests[0].headers
    assert headers["x-gateway-key"] == KEY
    assert "authorization" not in headers


def test_what_the_server_calls_the_model_is_in_the_transcript_where_it_differs(loopback: Loopback) -> None:
    asked = client(loopback, label="ours")
    assert asked.name == "ours"
    ledger = Ledger()
    ledger.note(QUESTION, ask(asked))
    assert asked.served == "m"
    loopback.plan = lambda request: Fault(wrap=lambda body: {**body, "model": "Qwen2.5-7B-Instruct-Q4_K_M.gguf"})
    ledger.note(QUESTION, ask(asked))
    _, (first, second) = ledger.close_step(0.0)
    assert "model" not in first["calls"][0]
    assert second["calls"][0]["model"] == asked.served == "Qwen2.5-7B-Instruct-Q4_K_M.gguf"
