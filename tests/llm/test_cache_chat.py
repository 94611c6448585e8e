"""A run that was kept is repeated without a server, to the last figure."""

from dataclasses import asdict, replace
from pathlib import Path

import pytest
from fake_sender import GOOD, FakeSender, chat, question, reply

from codriving.errors import ModelError
from codriving.llm.cache import AnswerCache
from codriving.llm.faults import CallError, FaultKind
from codriving.llm.question import Answer, Question
from codriving.llm.request import ChatRequest
from codriving.llm.spending import Spending


def troubled(request: ChatRequest, form: str) -> CallError | str:
    """A server with a short context, no JSON schema, and a bad first answer."""
    words = request.messages[1].content
    if form.startswith("json_schema"):
        return CallError(FaultKind.FORM, "400: response_format")
    if len(words) > 20:
        return CallError(FaultKind.TOO_LONG, "400: context")
    return "nonsense" if words == "bad" and len(request.messages) == 2 else GOOD


def asked() -> list[Question]:
    return [question(), question("bad"), question("x" * 30, shorter=lambda: question("x" * 10))]


def as_if_asked(answers: list[Answer]) -> list[Answer]:
    return [replace(a, calls=tuple(replace(call, cached=False) for call in a.calls)) for a in answers]


def test_replay_gives_the_same_answers_with_the_same_times_and_sends_nothing(tmp_path: Path) -> None:
    path = tmp_path / "answers.sqlite"
    first = chat(FakeSender(troubled), cache=AnswerCache(path, "use")).ask(asked())
    assert [len(answer.calls) for answer in first] == [1, 2, 2]
    sender, spending = FakeSender(), Spending(max_tokens_total=1)
    again = chat(sender, cache=AnswerCache(path, "replay"), spending=spending, replay=True).ask(asked())
    assert all(call.cached for answer in again for call in answer.calls)
    assert as_if_asked(again) == as_if_asked(first)
    assert not sender.sent
    assert spending.totals().tokens == 0


def test_same_question_is_paid_for_once_even_at_the_same_moment(tmp_path: Path) -> None:
    sender, spending = FakeSender(), Spending()
    client = chat(sender, cache=AnswerCache(tmp_path / "a", "use"), spending=spending)
    answers = client.ask([question()] * 5)
    assert len(sender.sent) == spending.totals().calls == 1
    assert sorted(answer.calls[0].cached for answer in answers) == [False, True, True, True, True]
    assert len({answer.calls[0].seconds for answer in answers}) == 1


@pytest.mark.parametrize(
    "changes", [{"model": "openai/other"}, {"api_base": "http://other/v1"}, {"temperature": 0.5}, {"max_tokens": 5}]
)
def test_what_changes_the_answer_is_asked_anew(tmp_path: Path, changes: dict[str, object]) -> None:
    path = tmp_path / "answers.sqlite"
    chat(FakeSender(), cache=AnswerCache(path, "use")).ask([question()])
    sender = FakeSender()
    chat(sender, cache=AnswerCache(path, "use"), **changes).ask([question()])
    assert len(sender.sent) == 1


def test_miss_in_replay_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "answers.sqlite"
    chat(FakeSender(), cache=AnswerCache(path, "use")).ask([question()])
    with pytest.raises(ModelError, match="replay"):
        chat(FakeSender(), cache=AnswerCache(path, "replay"), replay=True).ask([question("another")])


def test_failure_is_not_kept(tmp_path: Path) -> None:
    cache = AnswerCache(tmp_path / "a", "use")
    client = chat(FakeSender([CallError(FaultKind.SERVER)] * 4), cache=cache)
    with pytest.raises(Exception, match="asked 4 times"):
        client.ask([question()])
    assert client.ask([question()])[0].value is not None


def test_quicker_process_wins(tmp_path: Path) -> None:
    path = tmp_path / "answers.sqlite"

    def overtaken(request: ChatRequest, form: str) -> str:
        AnswerCache(path, "use").keep(request.told(), asdict(reply(GOOD.replace("free", "first"))))
        return GOOD

    answer = chat(FakeSender(overtaken), cache=AnswerCache(path, "use")).ask([question()])[0]
    assert answer.calls[0].text == GOOD.replace("free", "first")
