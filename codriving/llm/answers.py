"""The answer in a reply: which object of which place it is, or what is wrong in words that the model is told.

An answer may stand in several places, which are tried in this order: the content, the arguments of tool calls, and what
the model said to itself. From the first place with an object that fits the question, the last such object is taken. A
place is read strictly, and if that gives nothing, tolerantly: such an answer is mended.
"""

import html
import json
import re
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from pydantic import BaseModel, ValidationError

from codriving.llm.parsing import clean, is_page, one_line
from codriving.llm.prompts.free_text import the_one_of
from codriving.llm.question import Question
from codriving.llm.request import TOO_LONG, UNREADABLE, Reply, schema_of
from codriving.llm.tolerant import careless_values, merged

_WORDY = 2_000  # More of one text inside an answer is never used [characters]
_LONGEST = 500
_DEEPEST = 40  # Objects in objects that are looked into

CUT_OFF = ("length", "max_tokens")
FILTERED = ("content_filter", "safety", "refusal")

_TAG = re.compile(r"(?i)[<\[◁](/?)(?:think|thinking|thoughts?|reasoning|scratchpad)\b[^<>\[\]\n]{0,40}[>\]▷]|[{\[]")
_BEGUN = re.compile(r"[{\[]")
_FENCED = re.compile(r"\s*```\w*\s*\n?(.*?)\s*```\s*", re.DOTALL)
_DECODER = json.JSONDecoder(strict=False, object_pairs_hook=merged)


@dataclass(frozen=True, slots=True)
class JudgedReply:
    """What was read in a reply."""

    value: BaseModel | None
    problem: str = ""
    mended: bool = False  # Whether only the tolerant reading found it


def judge(reply: Reply, question: Question) -> JudgedReply:
    """Read an answer out of a reply."""
    problem = _unusable(reply)
    if problem:
        return JudgedReply(None, problem)
    spoken, thought = split_thoughts(reply.text)
    places = [text for text in (spoken, *reply.beside, thought) if text.strip()]
    problems: list[tuple[bool, str]] = []
    for place in places:
        for mended in (False, True):
            for value in reversed(mended_values(place, question) if mended else strict_values(place)):
                fit = _fit(value, question, problems, _DEEPEST)
                if fit is not None:
                    return JudgedReply(fit, "", mended or isinstance(value, list))
    if not places:
        return JudgedReply(None, "the answer is empty")
    if reply.finish_reason.lower() in CUT_OFF:
        return JudgedReply(None, "the answer was cut off at the token limit; keep it shorter")
    # Of what was said last, and rather of an object that names what is asked for.
    told = max(problems, key=lambda one: one[0], default=(False, "the answer holds no complete JSON object"))
    return JudgedReply(None, told[1])


def _unusable(reply: Reply) -> str:
    """Say why a reply cannot hold an answer; empty if it can."""
    if reply.finish_reason == TOO_LONG:
        return "the question is longer than the model's context"
    if reply.finish_reason == UNREADABLE or is_page(reply.text):
        return "the reply is no chat completion (a web page, or broken JSON)"
    if reply.refusal:
        return one_line(f"the model refused: {reply.refusal}", _LONGEST)
    return "the answer was withheld by a content filter" if reply.finish_reason.lower() in FILTERED else ""


def split_thoughts(text: str) -> tuple[str, str]:
    """Divide a text into what a model said and what it said to itself, which it may not have begun or ended properly.

    A tag inside an object is a word of the object.
    """
    said, thoughts, inside, last, start = "", "", False, 0, 0
    while found := _TAG.search(text, start):
        start = found.end()
        if found.group() in "{[":
            _, start = _outermost(text, found.start())
            continue
        closes, piece, last = bool(found.group(1)), text[last : found.start()], found.end()
        if inside:
            thoughts += f"{piece}\n"
        elif closes:
            said, thoughts = "", f"{thoughts}{said}{piece}\n"
        else:
            said += piece
        inside = not closes
    return (said, thoughts + text[last:]) if inside else (said + text[last:], thoughts)


def strict_values(text: str) -> list[Any]:
    """Read every outermost JSON object and list of a text."""
    found, start = [], 0
    while begun := _BEGUN.search(text, start):
        values, start = _outermost(text, begun.start())
        found += values
    return found


def _outermost(text: str, start: int) -> tuple[list[Any], int]:
    """Read the JSON value that begins at a place, if one does, and say where to go on."""
    try:
        value, end = _DECODER.raw_decode(text, start)
    except ValueError:
        return [], start + 1
    except RecursionError:
        return [], start + 500  # Beginnings in beginnings; to try each of them would take long
    return [value], end


def mended_values(text: str, question: Question) -> list[Any]:
    """Read a text tolerantly: objects that are no JSON, written as a text, in pieces, or left out around a name."""
    strict = strict_values(text)
    found: list[Any] = [strict] if strict else []
    found += [{key: _unwrapped(inner) for key, inner in value.items()} for value in strict if isinstance(value, dict)]
    for inner in _texts(text, strict, question):
        found += [*careless_values(inner), *strict_values(inner)]
    # All may be written for another language; where one object can be read it is not.
    plain = html.unescape(text).replace('\\"', '"').replace("\\n", "\n")
    found += careless_values(text) or ([] if strict else careless_values(plain))
    return [*found, *_named_alone(text, question)]


def _unwrapped(value: Any) -> Any:  # noqa: ANN401 - any JSON
    """Return the one word of a list, what is written as a text, or else the value as it is."""
    if isinstance(value, str) and value.lstrip()[:1] in ("{", "["):
        with suppress(ValueError, RecursionError):
            return json.loads(value)
    return value[0] if isinstance(value, list) and len(value) == 1 and isinstance(value[0], str) else value


def _texts(text: str, values: Sequence[Any], question: Question) -> Iterator[str]:
    """Give the texts that may hold an object written as a text: all that was said, or a member of an object."""
    with suppress(ValueError, RecursionError):
        whole = json.loads(_unfenced(text))
        if isinstance(whole, str):
            yield whole
            yield from _texts(whole, (), question)
    for value in values:
        if isinstance(value, dict) and not _answers(value, question):
            for inner in value.values():
                if isinstance(inner, str) and inner.lstrip()[:1] in ("{", "[", '"', "`"):
                    yield inner
                    yield from _texts(inner, (), question)


def _named_alone(text: str, question: Question) -> Iterator[dict[str, Any]]:
    """Make an object of a list or text in JSON that is all that was said and holds one name, if one is asked for."""
    whole, chosen, values = _unfenced(text), _choices(question), list[Any]()
    with suppress(ValueError, RecursionError):
        values = [json.loads(whole)]
    if not values and whole[:1] == "[" and whole[-1:] == "]":
        values = careless_values(whole)
    value = [values[0]] if values and isinstance(values[0], str) else values[0] if len(values) == 1 else None
    if isinstance(value, list) and len(value) == len(chosen) == 1:
        yield dict.fromkeys(chosen, value[0])


def _unfenced(text: str) -> str:
    fenced = _FENCED.fullmatch(text)
    return fenced.group(1) if fenced else text.strip()


def _choices(question: Question) -> dict[str, list[str]]:
    """Return the names that may be said, by the key of each choice."""
    properties = schema_of(question.schema).get("properties", {})
    return {key: node["enum"] for key, node in properties.items() if "enum" in node}


def _answers(value: dict[str, Any], question: Question) -> bool:
    """Whether an object names what is asked for, so that nothing inside it is the answer in its place."""
    keys = [*_choices(question), *getattr(question.schema, "older_keys", ())]
    return any(the_one_of(key, keys) is not None for key in value)


def _fit(
    value: Any,  # noqa: ANN401 - any JSON
    question: Question,
    problems: list[tuple[bool, str]],
    depth: int,
) -> BaseModel | None:
    """Return the answer that a value is, or else the last that it holds; what is wrong with it is noted."""
    if not isinstance(value, dict | list) or not depth:
        return None
    answer, problem = _validated(value, question)
    if answer is not None:
        return answer
    if isinstance(value, dict):
        problems.append((_answers(value, question), problem))
        if problems[-1][0]:
            return None
    for inner in reversed(list(value.values() if isinstance(value, dict) else value)):
        if (answer := _fit(inner, question, problems, depth - 1)) is not None:
            return answer
    return None


def _validated(value: Any, question: Question) -> tuple[BaseModel | None, str]:  # noqa: ANN401 - any JSON
    try:
        answer = question.schema.model_validate(_cleaned(_renamed(value, question)))
    except ValidationError as err:
        return None, one_line(f"the JSON does not fit: {_listed(err)}", _LONGEST)
    except RecursionError:
        return None, "the JSON is nested too deeply"
    wrong = question.check(answer)
    return (None, one_line(wrong, _LONGEST)) if wrong else (answer, "")


def _renamed(value: Any, question: Question) -> Any:  # noqa: ANN401 - any JSON
    """Call keys and names of an object as the form does, if exactly one of its names is meant."""
    if not isinstance(value, dict):
        return value
    keys, choices = list(schema_of(question.schema).get("properties", {})), _choices(question)
    named = merged([(the_one_of(key, keys) or key, inner) for key, inner in value.items()])
    return {key: the_one_of(inner, choices.get(key, ())) or inner for key, inner in named.items()}


def _cleaned(value: Any) -> Any:  # noqa: ANN401 - any JSON
    if isinstance(value, str):
        return clean(value, _WORDY)
    if isinstance(value, dict):
        return {clean(name, _WORDY): _cleaned(inner) for name, inner in value.items()}
    return [_cleaned(inner) for inner in value] if isinstance(value, list) else value


def _listed(error: ValidationError) -> str:
    parts = []
    for one in error.errors(include_url=False, include_context=False):
        where = ".".join(str(part) for part in one["loc"])
        parts.append(f"{where}: {one['msg']}" if where else one["msg"])
    return "; ".join(parts)
