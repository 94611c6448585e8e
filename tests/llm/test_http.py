"""Every fault over a real connection: what the asker gets, what is sent again, and that nothing leaks.

LiteLLM takes seconds to import, so everything that needs it stands in this one file.
"""

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import pytest
from fake_sender import SETTINGS, Choice, Waits
from faults import FAULTS, Fault
from loopback import Loopback

from codriving.errors import CodrivingError, ModelError, ModelUnavailableError
from codriving.llm.client import ModelChat
from codriving.llm.language_model import LanguageModel
from codriving.llm.question import Message, Question
from codriving.llm.request import Forms

CANARY = "sk-canary-0123456789abcdef"
PROMPT = "You are cav_0.\nAllowed actions: IDLE, SLOWER\n"

Connect = Callable[..., ModelChat]


@pytest.fixture(autouse=True)
def key(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CANARY_KEY", CANARY)
    # What LiteLLM would take if we did not tell it otherwise.
    monkeypatch.setenv("OPENAI_API_KEY", "sk-somebody-elses-key")
    monkeypatch.setenv("OPENAI_BASE_URL", "http://127.0.0.1:1/v1")
    monkeypatch.setenv("NO_PROXY", "127.0.0.1")


@pytest.fixture
def connect() -> Connect:
    """Clients of a server, ready to ask; they wait no time between attempts."""

    def made(server: Loopback | str, greet: bool = True, **changes: Any) -> ModelChat:
        settings = replace(
            SETTINGS,
            model="openai/loopback",
            api_base=server if isinstance(server, str) else server.url,
            api_key_env="CANARY_KEY",
            deadline=20.0,
            attempts=3,
            input_cost_per_token=None,
            output_cost_per_token=None,
        )
        client = ModelChat(replace(settings, **changes), sleep=Waits(), forms=Forms())
        if greet:
            client.preflight()
        if isinstance(server, Loopback):
            server.requests.clear()
            server.restart_plan(server.plan)
        return client

    return made


def question(**changes: Any) -> Question:
    messages = (Message("system", "You drive."), Message("user", PROMPT))
    return replace(Question("decide", "cav_0", messages, Choice), **changes)


def ask(client: ModelChat, asked: Question | None = None) -> Any:
    return client.ask([asked or question()])[0]


def test_answer_over_http(loopback: Loopback, connect: Connect) -> None:
    answer = ask(connect(loopback))
    assert answer.value.action == "IDLE"
    (sent,) = loopback.requests
    assert sent.headers["authorization"] == f"Bearer {CANARY}"
    assert sent.form == "json_schema"
    assert {name: sent.body[name] for name in ("model", "temperature", "max_tokens")} == {
        "model": "loopback",
        "temperature": 0.0,
        "max_tokens": 300,
    }
    assert [message["role"] for message in sent.messages] == ["system", "user"]
    assert answer.calls[0].prompt_tokens > 0 < answer.calls[0].completion_tokens


def test_key_of_somebody_else_is_not_sent_where_none_is_named(loopback: Loopback, connect: Connect) -> None:
    ask(connect(loopback, api_key_env=None))
    assert loopback.requests[0].headers["authorization"] == "Bearer none"


@pytest.mark.parametrize(
    ("model", "received"),
    [("my-model", "my-model"), ("Qwen/Qwen2.5-7B", "Qwen/Qwen2.5-7B"), ("hosted_vllm/a/b", "a/b")],
)
def test_names_that_servers_use_reach_them(loopback: Loopback, connect: Connect, model: str, received: str) -> None:
    assert ask(connect(loopback, model=model)).value is not None
    assert loopback.requests[0].body["model"] == received


@pytest.mark.parametrize("name", ["429", "429_dateless", "500", "502", "503", "drop", "drop_within", "echo_key_500"])
def test_what_may_pass_is_tried_again(loopback: Loopback, connect: Connect, name: str) -> None:
    client = connect(loopback)
    loopback.restart_plan([FAULTS[name]] * 2)
    answer = ask(client)
    assert answer.value.action == "IDLE"
    assert answer.calls[0].attempts == 3
    loopback.restart_plan([FAULTS[name]] * 3)
    with pytest.raises(ModelUnavailableError, match="asked 3 times") as failure:
        ask(client)
    assert_no_key(failure.value)
    assert len(loopback.requests) == 6


@pytest.mark.parametrize("fault", [Fault(hangs=True), Fault(trickle=0.05)], ids=["hangs", "trickles"])
def test_deadline_ends_what_would_take_for_ever(loopback: Loopback, connect: Connect, fault: Fault) -> None:
    client = connect(loopback)
    patient = connect(loopback, greet=False, deadline=0.5, attempts=1)
    assert ask(client).value is not None
    loopback.restart_plan([fault])
    with pytest.raises(ModelUnavailableError, match="did not answer in time"):
        ask(patient)


@pytest.mark.parametrize(
    "name",
    [
        *("empty_choices", "none_content", "empty_content", "cut_off", "filtered", "refusal", "html", "invalid_json"),
        *("not_an_object", "unknown_action"),
    ],
)
def test_unusable_answer_is_asked_for_once_more(loopback: Loopback, connect: Connect, name: str) -> None:
    client = connect(loopback)
    loopback.restart_plan([FAULTS[name]])
    answer = ask(client)
    assert answer.value.action == "IDLE"
    assert answer.asked_again
    loopback.restart_plan([FAULTS[name]] * 2)
    answer = ask(client)
    assert answer.value is None
    assert answer.problem
    assert len(answer.calls) == 2


@pytest.mark.parametrize(
    "name", ["think", "fence", "prose", "very_long", "very_long_prose", "control_characters", "raw_control_characters"]
)
def test_wrapped_and_wordy_answers_are_read(loopback: Loopback, connect: Connect, name: str) -> None:
    client = connect(loopback)
    loopback.restart_plan([FAULTS[name]])
    answer = ask(client)
    assert answer.value.action == "IDLE"
    assert len(answer.calls) == 1
    assert len(answer.calls[0].text) < 21_000
    assert "\x1b" not in answer.value.reason + answer.calls[0].text


def test_form_steps_down_and_is_remembered(serve: Callable[..., Loopback], connect: Connect) -> None:
    server = serve(forms=("text",))
    client = connect(server)
    assert ask(client).calls[0].form == "text"
    assert ask(client).value.action == "IDLE"
    sent = [request.form for request in server.requests]
    assert sent == ["json_schema", "json_schema", "json_object", "text", "text"]


def test_question_is_shortened_until_it_fits(serve: Callable[..., Loopback], connect: Connect) -> None:
    long = (Message("system", "You drive."), Message("user", PROMPT + "x" * 3000))
    asked = question(messages=long, shorter=question)
    answer = ask(connect(serve(context=2000)), asked)
    assert answer.value.action == "IDLE"
    assert answer.shortened == 1


@pytest.mark.parametrize(
    ("changes", "cure"),
    [
        ({"key": "another"}, "refuses the key in CANARY_KEY .*; set CANARY_KEY to a valid key"),
        ({"models": ["other"]}, "does not know the model openai/loopback .*; set llm.model"),
        ({"plan": lambda request: FAULTS["403"]}, "set CANARY_KEY"),
        ({"plan": lambda request: FAULTS["html"]}, "set llm.api_base"),
        ({"plan": lambda request: FAULTS["400"]}, "temperature"),
        ({"plan": lambda request: FAULTS["quota"]}, "has no credit left"),
        ({"plan": lambda request: FAULTS["echo_key_401"]}, "set CANARY_KEY"),
        ({"plan": lambda request: FAULTS["echo_key_500"]}, "llm.api_base"),
    ],
)
def test_preflight_refuses_in_one_line(
    serve: Callable[..., Loopback], connect: Connect, changes: dict[str, Any], cure: str
) -> None:
    with pytest.raises(ModelError, match=cure) as refusal:
        connect(serve(**changes))
    assert_no_key(refusal.value)


@pytest.mark.parametrize("address", ["http://127.0.0.1:1/v1", "http://nowhere.invalid/v1"])
def test_address_where_nobody_listens_is_refused_at_once(connect: Connect, address: str) -> None:
    with pytest.raises(ModelError, match=r"cannot be reached .*; start the server, or set llm\.api_base"):
        connect(address, attempts=20)


def test_provider_that_nobody_knows_is_refused(connect: Connect) -> None:
    with pytest.raises(ModelError, match=r"does not know the model nobody/nothing .*set llm\.model"):
        connect("http://127.0.0.1:1/v1", api_base=None, model="nobody/nothing")


@pytest.mark.parametrize("name", ["401", "echo_key_400", "echo_key_401", "404"])
def test_refusal_in_the_middle_ends_the_episode_and_shows_no_key(
    loopback: Loopback, connect: Connect, name: str
) -> None:
    client = connect(loopback)
    loopback.restart_plan([FAULTS[name]] * 5)
    times = "asked once" if name.endswith("401") else "asked 5 times"
    with pytest.raises(ModelUnavailableError, match=times) as failure:
        ask(client)
    assert_no_key(failure.value)


def test_no_credit_in_the_middle_stops_the_batch(loopback: Loopback, connect: Connect) -> None:
    client = connect(loopback)
    loopback.restart_plan([FAULTS["quota"]] * 5)
    with pytest.raises(ModelError, match=r"has no credit left .*; buy some, or set CANARY_KEY to another key"):
        ask(client)
    assert len(loopback.requests) == 1


def test_key_in_an_answer_is_hidden(loopback: Loopback, connect: Connect) -> None:
    client = connect(loopback)
    loopback.restart_plan([FAULTS["echo_key_answer"]])
    answer = ask(client)
    assert CANARY not in repr(answer)
    assert "***" in answer.calls[0].text


def test_many_at_once_share_few_connections(serve: Callable[..., Loopback], connect: Connect) -> None:
    server = serve(latency=0.05)
    client = connect(server, max_concurrency=4)
    assert len(client.ask([question()] * 12)) == 12
    assert server.high_water <= 4
    assert server.connections <= 5


@pytest.fixture
def apart() -> Iterator[str]:
    """Address of a server in a process of its own, so that its work and its files are not counted as ours."""
    code = [sys.executable, str(Path(__file__).with_name("loopback.py")), "--port", "0"]
    with subprocess.Popen(code, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None
        yield f"http://127.0.0.1:{int(server.stdout.readline())}/v1"
        server.terminate()


def test_300_calls_leave_no_file_open(apart: str, connect: Connect) -> None:
    at_once = 20
    client = connect(apart, max_concurrency=at_once)

    def files() -> int:
        return len(os.listdir("/proc/self/fd"))  # noqa: PTH208 - counted, not walked

    before = files()
    for _ in range(300 // at_once):
        assert all(answer.value is not None for answer in client.ask([question()] * at_once))
    # The greeting has opened one connection; there may be one for each request under way, and no more.
    assert files() < before + at_once


def test_settings_make_a_client_that_works(loopback: Loopback) -> None:
    changes = {"model": "openai/loopback", "api_base": loopback.url, "api_key_env": "CANARY_KEY", "temperature": None}
    made = LanguageModel(**{**asdict(SETTINGS), **changes, "max_tokens": 50})
    answer = ask(made.chat())
    call = answer.calls[0]
    assert call.cost == pytest.approx(call.prompt_tokens * 1e-6 + call.completion_tokens * 2e-6)
    assert "temperature" not in loopback.requests[0].body


def assert_no_key(error: CodrivingError) -> None:
    """Neither in the line nor in anything that hangs on to it."""
    assert "\n" not in str(error)
    link: BaseException | None = error
    while link is not None:
        assert "canary" not in repr(link)
        link = link.__cause__ or link.__context__
