"""What a model said: the JSON object in its words, or what is wrong with them in words that it is told."""

import json
import re
from typing import Any

from pydantic import BaseModel, ValidationError

from codriving.llm.question import Question
from codriving.llm.request import TOO_LONG, UNREADABLE, Reply

LONGEST = 20_000  # More of an answer is neither read nor written down [characters]

_LEFT_OUT = " ... "
_WORDY = 2_000  # More of one text inside an answer is never used [characters]

# Control and direction characters, and halves of surrogate pairs, which no file can hold; line ends and tabs stay.
_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u200b-\u200f\u2028-\u202e\u2066-\u2069\ufeff\ud800-\udfff]")
_THOUGHT = re.compile(r"(?is)<(think|thinking|reasoning)>.*?</\1>")
_ENDED = re.compile(r"(?is)^.*</(?:think|thinking|reasoning)>")
_BEGUN = re.compile(r"(?is)<(?:think|thinking|reasoning)>.*$")
_PAGE = re.compile(r"(?is)^\s*(?:<\?xml[^>]*>\s*)?<(?:!doctype html|html|head|body)\b")

_DECODER = json.JSONDecoder(strict=False)


def clean(text: str, longest: int = LONGEST) -> str:
    """Cap a text and take out the characters that neither a file nor a terminal should be given.

    What is too long loses its middle: an answer may stand at either end.
    """
    if len(text) > longest:
        half = longest // 2
        text = f"{text[:half]}{_LEFT_OUT}{text[-half:]}"
    return _CONTROL.sub("", text.replace("\r\n", "\n").replace("\r", "\n"))


def one_line(text: str, longest: int) -> str:
    """Put a text on one line and shorten it.

    Args:
        longest: Where it is cut [characters].
    """
    line = " ".join(clean(text).split())
    return line if len(line) <= longest else f"{line[: longest - 3]}..."


def is_page(text: str) -> bool:
    """Whether a text is a web page, as proxies and login portals send it."""
    return bool(_PAGE.match(text))


def last_object(text: str) -> dict[str, Any] | None:
    """Read the last balanced JSON object of a text."""
    # What a reasoning model said to itself, whether or not it closed or opened its thoughts properly, is left out.
    text, found, start = _BEGUN.sub("", _ENDED.sub("", _THOUGHT.sub("", text))), None, 0
    while (start := text.find("{", start)) >= 0:
        try:
            value, start = _DECODER.raw_decode(text, start)
        except (ValueError, RecursionError):
            start += 1
        else:
            found = value
    return None if found is None else _cleaned(found)


def _cleaned(value: Any) -> Any:  # noqa: ANN401 - any JSON
    if isinstance(value, str):
        return clean(value, _WORDY)
    if isinstance(value, dict):
        return {clean(name, _WORDY): _cleaned(inner) for name, inner in value.items()}
    return [_cleaned(inner) for inner in value] if isinstance(value, list) else value


_LONGEST = 500
_CUT_OFF = ("length", "max_tokens")
_FILTERED = ("content_filter", "safety", "refusal")


def judge(reply: Reply, question: Question) -> tuple[BaseModel | None, str]:
    """Read an answer out of a reply."""
    problem = _unusable(reply)
    if problem:
        return None, problem
    found = last_object(reply.text)
    if found is None:
        return None, "the answer holds no complete JSON object"
    try:
        value = question.schema.model_validate(found)
    except ValidationError as err:
        return None, one_line(f"the JSON does not fit: {_listed(err)}", _LONGEST)
    except RecursionError:
        return None, "the JSON is nested too deeply"
    wrong = question.check(value)
    return (None, one_line(wrong, _LONGEST)) if wrong else (value, "")


def _unusable(reply: Reply) -> str:
    """Say why a reply cannot hold an answer; empty if it can."""
    if reply.finish_reason == TOO_LONG:
        return "the question is longer than the model's context"
    if reply.finish_reason == UNREADABLE or is_page(reply.text):
        return "the reply is no chat completion (a web page, or broken JSON)"
    if reply.refusal:
        return one_line(f"the model refused: {reply.refusal}", _LONGEST)
    if reply.finish_reason.lower() in _FILTERED:
        return "the answer was withheld by a content filter"
    if reply.finish_reason.lower() in _CUT_OFF:
        return "the answer was cut off at the token limit; keep it shorter"
    return "" if reply.text.strip() else "the answer is empty"


def _listed(error: ValidationError) -> str:
    parts = []
    for one in error.errors(include_url=False, include_context=False):
        where = ".".join(str(part) for part in one["loc"])
        parts.append(f"{where}: {one['msg']}" if where else one["msg"])
    return "; ".join(parts)
