"""What is read in the answers of ``answers.yaml``, directly and as a server sends them through LiteLLM."""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from time import process_time
from typing import Any

import pytest
import yaml
from fake_sender import SETTINGS
from faults import Fault
from hypothesis import given
from hypothesis import strategies as st
from loopback import Loopback, Request
from thorough import THOROUGH

from codriving.llm.answers import JudgedReply, judge
from codriving.llm.client import ModelChat
from codriving.llm.parsing import clean
from codriving.llm.prompts.replies import (
    DecisionReply,
    LessonReply,
    OrderReply,
    decision_reply,
    first_of_pairs,
    order_reply,
)
from codriving.llm.question import Message, Question
from codriving.llm.request import Forms, Reply
from codriving.llm.send import reply_of

Case = dict[str, Any]

CASES: list[Case] = yaml.safe_load(Path(__file__).with_name("answers.yaml").read_text(encoding="utf-8"))
ROOT = Path(__file__).parents[2]
ACTIONS = ("SLOWER", "IDLE", "FASTER", "LANE_LEFT")
PAIRS = {
    "order": {"p1": ("CAV1", "CAV2"), "p2": ("CAV2", "CAV12")},
    "numbers": {"p1": ("7", "8")},
    "alike": {"p1": ("CAV-1", "CAV_1")},
    "named": {"CAV1_CAV2": ("CAV1", "CAV2"), "CAV2_CAV12": ("CAV2", "CAV12")},
    "pondered": {"CAV1_CAV2": ("CAV1", "CAV2"), "CAV2_CAV12": ("CAV2", "CAV12")},
}


def question(number: int) -> Question:
    """Ask what a case asks, with its number."""
    messages = (Message("system", "You drive."), Message("user", f"Case {number}"))
    ask = CASES[number]["ask"]
    if ask in ("decide", "ponder"):
        form = decision_reply(ACTIONS, thoughts=ask == "ponder", plan=ask == "ponder")
        return Question("decide", "x", messages, form, _allowed)
    if ask == "lesson":
        return Question("reflect", "x", messages, LessonReply, lambda said: "" if said.lesson else "it is empty")  # type: ignore[attr-defined]
    pairs = PAIRS[ask]
    wanted = "; ".join(f"{name}: {one} or {other}" for name, (one, other) in pairs.items())
    wish = f"no pair was ordered; say who goes first in each pair ({wanted})"
    return Question(
        "negotiate", "x", messages, order_reply(pairs, ask == "pondered"), lambda said: "" if _order(said) else wish
    )


def _allowed(said: Any) -> str:
    return "" if said.action in ACTIONS else f"{said.action} is not one of: {', '.join(ACTIONS)}"


def _order(said: Any) -> dict[str, str]:
    return {pair: first for pair, (first, _) in first_of_pairs(said).items()}


_NOT_OF_THE_MESSAGE = (
    "ask",
    "read",
    "refused",
    "mended",
    "finish_reason",
    "parts",
    "content",
    "tool_calls",
    "function_call",
)


def completion(case: Case) -> dict[str, Any]:
    """Write the body of a server's response."""
    message: Case = {"role": "assistant", "content": case.get("parts", case.get("content"))}
    message |= {name: value for name, value in case.items() if name not in _NOT_OF_THE_MESSAGE}
    if "tool_calls" in case:
        call = {"name": "answer", "arguments": case["tool_calls"]}
        message["tool_calls"] = [{"id": "a", "type": "function", "function": call}]
    if "function_call" in case:
        message["function_call"] = {"name": "answer", "arguments": case["function_call"]}
    choice = {"index": 0, "finish_reason": case.get("finish_reason", "stop"), "message": message}
    usage = {"prompt_tokens": 10, "completion_tokens": 5, "total_tokens": 15}
    return {"id": "a", "object": "chat.completion", "created": 0, "model": "any", "choices": [choice], "usage": usage}


def check(case: Case, value: object, problem: str, mended: bool) -> None:
    """Compare what was read with what is expected."""
    if "refused" in case:
        assert value is None
        assert case["refused"] in problem
    else:
        assert value is not None, problem
        found = {DecisionReply: lambda v: v.action, LessonReply: lambda v: v.lesson, OrderReply: _order}
        read = next(read for kind, read in found.items() if isinstance(value, kind))
        assert read(value) == case["read"]
        assert mended is case.get("mended", False)


def shown(number: int) -> str:
    return f"{number} {json.dumps({k: v for k, v in CASES[number].items() if k not in ('ask', 'read', 'refused')})}"[
        :60
    ]


def test_table_is_long_and_says_what_is_expected() -> None:
    assert len(CASES) >= 80
    assert all(("read" in case) != ("refused" in case) for case in CASES)


@pytest.mark.parametrize("number", range(len(CASES)), ids=shown)
def test_answer_is_read(number: int) -> None:
    read: JudgedReply = judge(reply_of(completion(CASES[number])), question(number))
    check(CASES[number], read.value, read.problem, read.mended)


@pytest.fixture(scope="module")
def server() -> Iterator[Loopback]:
    def plan(request: Request) -> Fault:
        case = CASES[int(str(request.messages[1]["content"]).split()[1])]
        return Fault(wrap=lambda sent: completion(case))

    with Loopback(plan) as running:
        yield running


def thought_only(case: Case) -> bool:
    """Whether all tokens went into thinking: more of the same would."""
    return case.get("finish_reason") == "length" and not case.get("content")


@pytest.mark.parametrize("model", ["openai/any", "hosted_vllm/any"])
def test_answers_are_read_through_litellm(server: Loopback, model: str) -> None:
    chat = ModelChat(replace(SETTINGS, model=model, api_base=server.url), forms=Forms())
    # What differs for a server of vLLM's is little of the way.
    numbers = range(0, len(CASES), 1 if THOROUGH or model == "openai/any" else 4)
    answers = chat.ask([question(number) for number in numbers])
    for case, answer in zip((CASES[number] for number in numbers), answers, strict=True):
        check(case, answer.value, answer.problem, answer.mended)
        assert len(answer.calls) == (2 if "refused" in case and not thought_only(case) else 1), case
        assert answer.calls[0].prompt_tokens == 10


_ASKED_ALONE = """
import sys
from dataclasses import replace
from fake_sender import SETTINGS
from test_answers import CASES, question
from codriving.llm.client import ModelChat
chat = ModelChat(replace(SETTINGS, api_base=sys.argv[1]))
odd = [k for k, case in enumerate(CASES) if ("parts" in case or "tool_calls" in case) and "read" in case]
assert len(odd) > 9
assert all(answer.value for answer in chat.ask([question(k) for k in odd]))
"""


def test_odd_places_are_read_without_a_word_on_the_screen(server: Loopback) -> None:
    folders = Path(__file__).parent, ROOT / "tests", ROOT
    path = os.pathsep.join((*map(str, folders), os.environ.get("PYTHONPATH", "")))
    command = [sys.executable, "-c", _ASKED_ALONE, server.url]
    done = subprocess.run(command, env={**os.environ, "PYTHONPATH": path}, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


PLAIN = Question("decide", "x", (), decision_reply(ACTIONS), _allowed)


def decided(text: str) -> DecisionReply:
    value = judge(Reply(clean(text), "stop"), PLAIN).value
    assert isinstance(value, DecisionReply)
    return value


def test_answer_at_either_end_of_a_very_long_text_is_read() -> None:
    text = '{"action": "IDLE"}'
    assert decided("so " * 350_000 + text).action == decided(text + " so" * 350_000).action == "IDLE"
    long = decided(json.dumps({"reason": "so " * 350_000, "action": "IDLE"}))
    assert (long.action, len(long.reason)) == ("IDLE", 159)


def test_control_characters_go_even_if_they_were_escaped() -> None:
    said = decided('{"reason": "\\u001b[31mred\\u0000 \\ud800\\u202eend", "action": "IDLE"}')
    assert said.reason == "[31mred end"


@pytest.mark.parametrize(
    "piece", ['{"', '{"a":', '{"a":"b" c ', "['", "{a:/*", "{a:#", "[", '{"a\\', '"{\\"', "<think>", "{'a':["]
)
def test_no_text_takes_long_or_ends_anything(piece: str) -> None:
    begun = process_time()
    assert judge(Reply(clean(piece * 20_000), "stop"), PLAIN).value is None
    assert process_time() - begun < 5.0


@given(st.text(max_size=60), st.text("{}[]\"',:ab\\ ", max_size=40))
def test_nothing_is_made_up_from_words(text: str, marks: str) -> None:
    assert judge(Reply(clean(f"{marks}{text}{marks}"), "stop"), PLAIN).value is None


@given(st.text('[]" ,:ab\\'), st.sampled_from(ACTIONS))
def test_object_after_anything_is_found(before: str, action: str) -> None:
    assert decided(f'{before}\n{{"action": "{action}"}}').action == action


def test_nothing_is_read_that_was_not_said_whatever_is_cut_off() -> None:
    texts = [case["content"] for case in CASES if case["ask"] == "decide" and isinstance(case.get("content"), str)]
    assert len(texts) > 60
    for text in texts:
        for end in range(0, len(text), 3):
            value = judge(Reply(text[:end], "length"), PLAIN).value
            assert value is None or letters(value.action) in letters(text[:end]), text[:end]  # type: ignore[attr-defined]


def letters(text: str) -> str:
    return "".join(c for c in text.lower() if c.isalnum())


@given(st.integers(0, 40))
def test_a_cut_name_is_never_completed(length: int) -> None:
    whole = '{"reason": "so", "p2": "CAV12"}'
    asked = Question("negotiate", "x", (), order_reply(PAIRS["order"]), lambda said: "" if _order(said) else "none")
    value = judge(Reply(whole[:length], "stop"), asked).value
    assert value is None or _order(value) == {"p2": "CAV12"}
