"""What is made of the replies of a server, good and bad; nothing waits and nothing is sent."""

import asyncio
import threading
from concurrent.futures import Future
from typing import Any

import pytest
from fake_sender import GOOD, Choice, FakeSender, Waits, chat, question, reply

from codriving.errors import ModelError, ModelUnavailableError, SpendingLimitError
from codriving.llm.attempts import Retry
from codriving.llm.faults import CallError, FaultKind
from codriving.llm.question import Answer, Question
from codriving.llm.request import ChatRequest
from codriving.llm.spending import Spending

BAD = {
    "empty choices": reply("", ""),
    "empty content": reply("  "),
    "cut off": reply(GOOD[:20], "length"),
    "filtered": reply("", "content_filter"),
    "refusal": reply("", refusal="I cannot help with that."),
    "page": reply("<html><body>Sign in</body></html>"),
    "unreadable": CallError(FaultKind.UNREADABLE, "html"),
    "blocked": CallError(FaultKind.FILTERED, "400: policy"),
    "no JSON": reply("IDLE"),
    "unknown action": reply('{"reason": "x", "action": "FLY"}'),
    "missing field": reply('{"action": "IDLE"}'),
}


def ask(client: Any, asked: Question | None = None) -> Answer:
    answers = client.ask([asked or question()])
    assert len(answers) == 1
    assert isinstance(answers[0], Answer)
    return answers[0]


def test_good_answer_is_read_and_accounted_for() -> None:
    sender, spending = FakeSender(), Spending()
    answer = ask(chat(sender, spending=spending))
    assert answer.value == Choice(reason="free", action="IDLE")
    (call,) = answer.calls
    assert (call.prompt_tokens, call.completion_tokens, call.attempts, call.form) == (100, 10, 1, "json_schema")
    assert call.cost == pytest.approx(120e-6)
    assert (call.text, call.problem, call.cached) == (GOOD, "", False)
    assert spending.totals().tokens == 110
    assert not answer.asked_again


@pytest.mark.parametrize("name", BAD)
def test_bad_answer_is_asked_for_again_with_what_was_wrong(name: str) -> None:
    sender = FakeSender([BAD[name]])
    answer = ask(chat(sender))
    assert answer.value == Choice(reason="free", action="IDLE")
    assert answer.asked_again
    first, second = answer.calls
    assert first.problem
    *before, said, told = second.messages
    assert tuple(before) == first.messages
    assert (said.role, told.role) == ("assistant", "user")
    assert said.content.strip(), "some servers refuse an empty message"
    assert first.problem in told.content


@pytest.mark.parametrize("name", BAD)
def test_two_bad_answers_are_none(name: str) -> None:
    sender = FakeSender([BAD[name]] * 2)
    answer = ask(chat(sender))
    assert answer.value is None
    assert answer.problem == answer.calls[-1].problem != ""
    assert len(sender.sent) == 2


def test_what_the_asker_finds_wrong_is_told_once() -> None:
    asked = question(check=lambda value: "IDLE is not allowed any more; allowed: SLOWER")
    answer = ask(chat(FakeSender()), asked)
    assert answer.value is None
    assert len(answer.calls) == 2
    assert "allowed: SLOWER" in answer.calls[1].messages[-1].content


def test_long_question_is_shortened_until_it_fits() -> None:
    def reply_to(request: ChatRequest, form: str) -> CallError | str:
        long = len(request.messages[1].content) > 10
        return CallError(FaultKind.TOO_LONG, "400: context") if long else GOOD

    def of(length: int) -> Question:
        return question("x" * length, shorter=lambda: of(length - 10) if length > 10 else None)

    answer = ask(chat(FakeSender(reply_to)), of(30))
    assert answer.value is not None
    assert answer.shortened == 2
    assert not answer.asked_again
    assert [len(call.messages[1].content) for call in answer.calls] == [30, 20, 10]


def test_question_that_cannot_be_shortened_has_no_answer() -> None:
    answer = ask(chat(FakeSender([CallError(FaultKind.TOO_LONG)])))
    assert answer.value is None
    assert "longer than the model's context" in answer.problem
    assert not answer.asked_again


def test_form_is_stepped_down_once_for_all_questions() -> None:
    def reply_to(request: ChatRequest, form: str) -> CallError | str:
        return GOOD if form == "text" else CallError(FaultKind.FORM, f"400: response_format {form}")

    sender = FakeSender(reply_to)
    client = chat(sender)
    (call,) = ask(client).calls
    assert (call.form, call.attempts) == ("text", 4)
    assert "JSON schema" in call.messages[1].content
    client.ask([question()] * 3)
    steps = ["json_schema", "json_schema_any_length", "json_object", "text"]
    assert [form for _, form, _ in sender.sent] == [*steps, "text", "text", "text"]


def test_a_longer_answer_is_given_its_length() -> None:
    sender = FakeSender()
    ask(chat(sender), question(more_tokens=600))
    ask(chat(sender))
    assert [request.max_tokens for request, _, _ in sender.sent] == [900, 300]


@pytest.mark.parametrize("kind", [FaultKind.TIMEOUT, FaultKind.DROPPED, FaultKind.RATE, FaultKind.SERVER])
def test_what_may_pass_is_tried_again_and_seen(kind: FaultKind) -> None:
    waits, seen = Waits(), list[Retry]()
    client = chat(FakeSender([CallError(kind, "500: busy")] * 3), waits)
    client.on_retry = seen.append
    (call,) = ask(client).calls
    assert call.attempts == 4
    assert [0.5 <= wait / 2**index <= 1 for index, wait in enumerate(waits)] == [True] * 3
    assert [retry.attempt for retry in seen] == [1, 2, 3]
    assert "busy" in str(seen[0])
    assert "attempt 2 of 4" in str(seen[0])


@pytest.mark.parametrize("kind", [FaultKind.TIMEOUT, FaultKind.DROPPED, FaultKind.RATE, FaultKind.SERVER])
def test_retries_are_bounded_and_end_the_episode(kind: FaultKind) -> None:
    sender = FakeSender([CallError(kind)] * 99)
    with pytest.raises(ModelUnavailableError, match="asked 4 times"):
        ask(chat(sender))
    assert len(sender.sent) == 4


def test_wait_that_the_server_asks_for_is_kept() -> None:
    waits = Waits()
    ask(chat(FakeSender([CallError(FaultKind.RATE, "429", retry_after=20.0)]), waits))
    assert 20 <= waits[0] <= 20.2


def test_server_that_asks_for_an_hour_is_given_up() -> None:
    sender = FakeSender([CallError(FaultKind.RATE, "429", retry_after=3600.0)] * 9)
    with pytest.raises(ModelUnavailableError, match="asked once"):
        ask(chat(sender))


@pytest.mark.parametrize("kind", [FaultKind.KEY, FaultKind.MODEL, FaultKind.QUOTA, FaultKind.UNREACHABLE])
def test_what_the_user_must_mend_is_refused_at_the_first_call_and_ends_an_episode_later(kind: FaultKind) -> None:
    with pytest.raises(ModelError, match=r"set |buy"):
        ask(chat(FakeSender([CallError(kind, "no")] * 20)))
    client = chat(FakeSender([GOOD, *[CallError(kind, "no")] * 9]))
    ask(client)
    with pytest.raises(ModelError if kind is FaultKind.QUOTA else ModelUnavailableError):
        ask(client)


def test_what_is_refused_in_every_way_ends_the_episode() -> None:
    sender = FakeSender([GOOD, *[CallError(FaultKind.REFUSED, "400: no")] * 9])
    client = chat(sender)
    ask(client)
    with pytest.raises(ModelUnavailableError, match=r"400: no.*asked 5 times; change the setting of llm that"):
        ask(client)
    forms = [form for _, form, _ in sender.sent[1:]]
    assert forms == ["json_schema", "json_schema_any_length", "json_object", "text", "text"]


def test_attempt_that_never_ends_is_ended_by_the_deadline() -> None:
    async def never(request: ChatRequest, form: str) -> str:
        await asyncio.Event().wait()
        raise AssertionError

    sender = FakeSender(lambda request, form: never(request, form))
    with pytest.raises(
        ModelUnavailableError,
        match=r"did not answer in time \(0.1 s; no answer so far\), asked 2 times; raise llm.deadline or lower",
    ):
        ask(chat(sender, deadline=0.1, attempts=2))


def test_all_questions_of_a_step_are_asked_at_once_and_answered_in_order() -> None:
    def reply_to(request: ChatRequest, form: str) -> str:
        return GOOD.replace("free", request.messages[1].content)

    sender = FakeSender(reply_to)
    answers = chat(sender, max_concurrency=3).ask([question(str(index)) for index in range(10)])
    assert [answer.value.reason for answer in answers if isinstance(answer.value, Choice)] == [*"0123456789"]
    assert sender.most == 3


def test_one_that_fails_does_not_stop_the_others_from_being_paid_for() -> None:
    def reply_to(request: ChatRequest, form: str) -> str | CallError:
        return CallError(FaultKind.REFUSED, "400") if request.messages[1].content == "0" else GOOD

    spending = Spending()
    with pytest.raises(ModelUnavailableError):
        chat(FakeSender(reply_to), spending=spending).ask([question(str(index)) for index in range(4)])
    assert spending.totals().calls == 3


def test_any_thread_may_ask() -> None:
    client, found = chat(FakeSender()), list[Answer]()
    threads = [threading.Thread(target=lambda: found.extend(client.ask([question()] * 5))) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 40
    assert all(answer.value is not None for answer in found)


def test_nothing_asked_is_nothing_sent() -> None:
    sender = FakeSender()
    assert chat(sender).ask([]) == []
    assert not sender.sent


def test_429_lets_fewer_through() -> None:
    sender = FakeSender([CallError(FaultKind.RATE)] * 8)
    client = chat(sender, max_concurrency=8)
    client.ask([question(str(index)) for index in range(8)])
    sender.most = 0
    client.ask([question(str(index)) for index in range(8)])
    assert sender.most <= 6


def test_limit_is_looked_at_before_a_step() -> None:
    sender, spending = FakeSender(), Spending(max_tokens_total=100)
    client = chat(sender, spending=spending)
    client.ask([question("a"), question("b")])
    with pytest.raises(SpendingLimitError):
        client.ask([question("c")])
    assert len(sender.sent) == 2


def test_key_is_read_when_it_is_used(monkeypatch: pytest.MonkeyPatch) -> None:
    sender = FakeSender()
    client = chat(sender, api_key_env="FAKE_KEY")
    monkeypatch.delenv("FAKE_KEY", raising=False)
    with pytest.raises(ModelError, match="FAKE_KEY is not set"):
        ask(client)
    monkeypatch.setenv("FAKE_KEY", " canary\n")
    ask(client)
    assert sender.sent[0][2] == "canary"
    monkeypatch.setenv("FAKE_KEY", "can ary\x07")
    with pytest.raises(ModelError, match="FAKE_KEY holds characters") as refusal:
        ask(client)
    assert "ary" not in str(refusal.value).replace("FAKE_KEY", "")


PREFLIGHT: list[tuple[CallError, str]] = [
    (CallError(FaultKind.KEY, "401"), "set FAKE_KEY to a valid key"),
    (CallError(FaultKind.MODEL, "404"), "set llm.model"),
    (CallError(FaultKind.UNREACHABLE, "refused"), "set llm.api_base"),
    (CallError(FaultKind.UNREADABLE, "html"), "set llm.api_base"),
    (CallError(FaultKind.TIMEOUT), "llm.deadline"),
    (CallError(FaultKind.QUOTA, "429"), "FAKE_KEY"),
    (CallError(FaultKind.REFUSED, "400: temperature"), "400: temperature"),
]


@pytest.mark.parametrize(("fault", "cure"), PREFLIGHT, ids=lambda part: str(part))
def test_preflight_refuses_in_one_line_that_says_what_to_set(
    fault: CallError, cure: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("FAKE_KEY", "canary")
    sender = FakeSender([fault] * 9)
    with pytest.raises(ModelError, match=cure) as refusal:
        chat(sender, api_key_env="FAKE_KEY").preflight()
    assert "\n" not in str(refusal.value)
    assert refusal.value.__cause__ is refusal.value.__context__ is None
    if fault.kind is FaultKind.UNREACHABLE:
        assert len(sender.sent) == 1


@pytest.mark.parametrize("said", ["yes", reply(""), reply("y", "length")])
def test_preflight_is_content_with_any_completion_and_makes_one_call(said: Any) -> None:
    sender = FakeSender([said])
    client = chat(sender)
    client.preflight()
    client.preflight()
    assert len(sender.sent) == 1
    assert sender.sent[0][0].schema is None


def test_preflight_without_key_or_address_sends_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("FAKE_KEY", raising=False)
    sender = FakeSender()
    refused: list[tuple[dict[str, Any], str]] = [
        ({"api_key_env": "FAKE_KEY"}, "FAKE_KEY is not set"),
        ({"api_base": None}, "llm.api_base must be"),
    ]
    for settings, line in refused:
        with pytest.raises(ModelError, match=line):
            chat(sender, **settings).preflight()
    chat(sender, replay=True).preflight()
    assert not sender.sent


def test_interrupted_waiting_cancels_the_questions(monkeypatch: pytest.MonkeyPatch) -> None:
    begun, cancelled = threading.Event(), threading.Event()

    async def never(request: ChatRequest, form: str) -> str:
        begun.set()
        try:
            await asyncio.Event().wait()
        finally:
            cancelled.set()
        raise AssertionError

    waiting, result = threading.current_thread(), Future.result

    def interrupted(self: Future[Any], timeout: float | None = None) -> Any:
        if threading.current_thread() is not waiting:
            return result(self, timeout)
        assert begun.wait(5)
        raise KeyboardInterrupt

    monkeypatch.setattr(Future, "result", interrupted)
    with pytest.raises(KeyboardInterrupt):
        ask(chat(FakeSender(lambda request, form: never(request, form))))
    assert cancelled.wait(5)
