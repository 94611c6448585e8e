"""Why an answer ends, and which tokens were cached or thoughts: from the server into transcript and record."""

from typing import Any

import pytest
from fake_sender import FakeSender, chat, question, reply

from codriving.llm.ledger import Ledger
from codriving.llm.request import Reply
from codriving.llm.send import reply_of


def usage(**more: Any) -> dict[str, Any]:
    """A chat completion with a usage."""
    choice = {"finish_reason": "stop", "message": {"content": "yes"}}
    return {"choices": [choice], "usage": {"prompt_tokens": 900, "completion_tokens": 80, **more}}


@pytest.mark.parametrize(
    ("told", "cached", "thought"),
    [
        ({"prompt_tokens_details": {"cached_tokens": 512}}, 512, 0),
        ({"completion_tokens_details": {"reasoning_tokens": 64}}, 0, 64),
        ({"cache_read_input_tokens": 700}, 700, 0),
        ({"prompt_cache_hit_tokens": 300}, 300, 0),
        ({"prompt_tokens_details": None, "completion_tokens_details": {"reasoning_tokens": None}}, 0, 0),
        ({"prompt_tokens_details": [1], "completion_tokens_details": "many"}, 0, 0),
        ({"prompt_tokens_details": {"cached_tokens": "x"}}, 0, 0),
        ({}, 0, 0),
    ],
)
def test_servers_say_it_in_several_places(told: dict[str, Any], cached: int, thought: int) -> None:
    found = reply_of(usage(**told))
    assert (found.cached_tokens, found.reasoning_tokens) == (cached, thought)


def test_a_ledger_sums_them_and_keeps_each() -> None:
    said = [
        reply("{", "length", cached_tokens=50, reasoning_tokens=7),
        reply(cached_tokens=60),
        reply("", "content_filter"),
        reply("", "content_filter"),
    ]
    client, ledger = chat(FakeSender(said)), Ledger()
    for _ in range(2):
        asked = question()
        [answer] = client.ask([asked])
        ledger.note(asked, answer)
    counts, lines = ledger.close_step(0.5)
    assert (counts["cached_tokens"], counts["reasoning_tokens"]) == (110, 7)
    assert (counts["cut_off"], counts["withheld"]) == (1, 2)
    calls = [call for line in lines for call in line["calls"]]
    assert [call["finish_reason"] for call in calls] == ["length", "stop", "content_filter", "content_filter"]
    assert [call["cached_tokens"] for call in calls] == [50, 60, 0, 0]
    assert [call["reasoning_tokens"] for call in calls] == [7, 0, 0, 0]


def test_a_reply_in_a_cache_of_before_is_read() -> None:
    old = {"text": "yes", "finish_reason": "stop", "prompt_tokens": 3, "beside": [], "model": "m", "counted": True}
    assert Reply.from_dict(old) == Reply("yes", "stop", prompt_tokens=3, model="m")
