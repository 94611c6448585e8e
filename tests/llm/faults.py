"""What can go wrong at a server or in an answer, each by a name."""

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

from reading import ACTIONS, Pair, Reading

CONTROL = "\x1b[31mred\x07\u202e\x00 end"
"""Characters that no terminal should be given."""


def same(reading: Reading) -> Reading:
    """No change."""
    return reading


def as_it_is(content: str) -> str | None:
    """No change."""
    return content


def untouched(completion: dict[str, Any]) -> dict[str, Any]:
    """No change."""
    return completion


@dataclass(frozen=True)
class Fault:
    """What goes wrong with one request; as it stands, nothing does.

    Attributes:
        latency: How long the answer takes on top of the server's own latency [s].
        hangs: Whether it never answers.
        drops: Whether the connection is closed: ``before`` the answer, or ``within`` it; empty if not.
        trickle: Time between two bytes of the answer [s]; 0 sends it at once.
        status: HTTP status.
        headers: Further headers.
        error: Message of an error body; ``{authorization}`` stands for the header that the client sent.
        code: Code of an error body.
        page: HTML that is sent instead of JSON.
        only_for: Forms of answer (``json_schema``, ``json_object``, ``text``) that it happens to; empty is all.
        read: Changes the answer before it takes its form.
        write: Changes the text of the answer.
        wrap: Changes the body of the response.
        pack: Changes the bytes of the body.
        endless: What is sent over and over after the body, in chunks, until the client goes; empty sends nothing.
    """

    latency: float = 0.0
    hangs: bool = False
    drops: str = ""
    trickle: float = 0.0
    status: int = 200
    headers: Mapping[str, str] = field(default_factory=dict)
    error: str = ""
    code: str = ""
    page: str = ""
    only_for: tuple[str, ...] = ()
    read: Callable[[Reading], Reading] = same
    write: Callable[[str], str | None] = as_it_is
    wrap: Callable[[dict[str, Any]], dict[str, Any]] = untouched
    pack: Callable[[bytes], bytes] = bytes
    endless: bytes = b""


def too_many(retry_after: str = "0") -> Fault:
    """429, with how long to wait.

    Args:
        retry_after: Value of the header: seconds or a date.
    """
    return Fault(
        status=429, headers={"Retry-After": retry_after}, error="Rate limit reached", code="rate_limit_exceeded"
    )


def moved(status: int, to: str) -> Fault:
    """A redirect.

    Args:
        status: 301, 302, 303, 307 or 308.
        to: Where to.
    """
    return Fault(status=status, headers={"Location": to}, page="moved")


def too_long(limit: int, length: int) -> Fault:
    """400, as OpenAI says it.

    Args:
        limit: Characters that are taken.
        length: Characters that were sent.
    """
    message = (
        f"This model's maximum context length is {limit // 4} tokens. However, your messages resulted in "
        f"{length // 4} tokens. Please reduce the length of the messages."
    )
    return Fault(status=400, error=message, code="context_length_exceeded")


def no_such_form(form: str) -> Fault:
    """400, as a server says it that does not know a form of answer.

    Args:
        form: ``json_schema`` or ``json_object``.
    """
    return Fault(
        status=400,
        error=f"Invalid parameter: 'response_format' of type '{form}' is not supported with this model.",
        code="invalid_request_error",
        only_for=(form,),
    )


def _choice(**changes: Any) -> Callable[[dict[str, Any]], dict[str, Any]]:
    """Changes what lies beside the text in the only choice."""

    def wrap(completion: dict[str, Any]) -> dict[str, Any]:
        completion["choices"][0] |= changes
        return completion

    return wrap


def _refusal(completion: dict[str, Any]) -> dict[str, Any]:
    completion["choices"][0]["message"] |= {"content": None, "refusal": "I cannot help with that."}
    return completion


def _removed(reading: Reading) -> Reading:
    """An action that exists but is not allowed; an unknown one where all are."""
    gone = [action for action in ACTIONS if action not in reading.allowed]
    return replace(reading, action=gone[0] if gone else "FLY") if reading.allowed else reading


def _unknown_ids(reading: Reading) -> Reading:
    head, tail = reading.pairs[:1], reading.pairs[1:]
    return replace(reading, pairs=(*(Pair("P999", "CAV999", p.first) for p in head), *tail))


def _duplicate_ids(reading: Reading) -> Reading:
    return replace(reading, pairs=(*reading.pairs, *(p.turned() for p in reading.pairs[:1])))


def _cyclic(reading: Reading) -> Reading:
    """Turn the pairs along a circle, if they hold one."""
    circle = _circle(reading.pairs)
    along = set(pairwise([*circle, *circle[:1]]))
    pairs = tuple(p.turned() if (p.second, p.first) in along else p for p in reading.pairs)
    return replace(reading, pairs=pairs)


def _circle(pairs: tuple[Pair, ...]) -> list[str]:
    """Vehicles each of which is paired with the next, and the last with the first; empty if there are none."""
    beside: dict[str, list[str]] = {}
    for pair in pairs:
        if way := _way(beside, pair.first, pair.second):
            return way
        beside.setdefault(pair.first, []).append(pair.second)
        beside.setdefault(pair.second, []).append(pair.first)
    return []


def _way(beside: Mapping[str, list[str]], begin: str, end: str) -> list[str]:
    """A way from one to the other over pairs; empty if there is none."""
    ways, seen = [[begin]], {begin}
    while ways:
        way = ways.pop(0)
        if way[-1] == end:
            return way
        for name in beside.get(way[-1], ()):
            if name not in seen:
                seen.add(name)
                ways.append([*way, name])
    return []


OPENAI_KEY = "Incorrect API key provided. You sent '{authorization}'."

FAULTS: dict[str, Fault] = {
    "ok": Fault(),
    "timeout": Fault(hangs=True),
    "trickle": Fault(trickle=0.01),
    "drop": Fault(drops="before"),
    "drop_within": Fault(drops="within"),
    "500": Fault(status=500, error="The server had an error", code="server_error"),
    "502": Fault(status=502, page="<html><body><h1>502 Bad Gateway</h1></body></html>"),
    "503": Fault(status=503, error="The engine is overloaded", code="server_error"),
    "429": too_many("0"),
    "429_dateless": Fault(status=429, error="Rate limit reached", code="rate_limit_exceeded"),
    "quota": Fault(status=429, error="You exceeded your current quota", code="insufficient_quota"),
    "401": Fault(status=401, error="Incorrect API key provided", code="invalid_api_key"),
    "403": Fault(status=403, error="You are not allowed to use this model", code="forbidden"),
    "404": Fault(status=404, error="The model does not exist or you do not have access to it", code="model_not_found"),
    "400": Fault(status=400, error="Invalid value for 'temperature'", code="invalid_request_error"),
    "no_json_schema": no_such_form("json_schema"),
    "no_json_object": no_such_form("json_object"),
    "too_long": too_long(4000, 8000),
    "echo_key_401": Fault(status=401, error=OPENAI_KEY, code="invalid_api_key"),
    "echo_key_400": Fault(status=400, error="Bad request with {authorization}", code="invalid_request_error"),
    "echo_key_500": Fault(status=500, error="Crashed while serving {authorization}", code="server_error"),
    "echo_key_answer": Fault(write=lambda content: content.replace("asks for", "asks for {authorization}")),
    "empty_choices": Fault(wrap=lambda completion: completion | {"choices": []}),
    "none_content": Fault(write=lambda content: None),
    "empty_content": Fault(write=lambda content: ""),
    "cut_off": Fault(write=lambda content: content[: len(content) // 2], wrap=_choice(finish_reason="length")),
    "refusal": Fault(wrap=_refusal),
    "filtered": Fault(write=lambda content: "", wrap=_choice(finish_reason="content_filter")),
    "html": Fault(page="<html><body>Please log in to the hospital network.</body></html>"),
    "invalid_json": Fault(write=lambda content: content.replace(":", "", 1)),
    "not_an_object": Fault(write=lambda content: json.dumps([content])),
    "think": Fault(
        write=lambda content: f'<think>\nPerhaps {{"action": "FASTER"}}? No {{ not so.\n</think>\n\n{content}'
    ),
    "fence": Fault(write=lambda content: f"```json\n{content}\n```"),
    "prose": Fault(write=lambda content: f"Here is my answer {{as you asked}}:\n{content}\nI hope that this helps."),
    "unknown_action": Fault(read=lambda reading: replace(reading, action="FLY") if reading.allowed else reading),
    "removed_action": Fault(read=_removed),
    "unknown_ids": Fault(read=_unknown_ids),
    "duplicate_ids": Fault(read=_duplicate_ids),
    "missing_ids": Fault(read=lambda reading: replace(reading, pairs=reading.pairs[:-1])),
    "cyclic": Fault(read=_cyclic),
    "very_long": Fault(read=lambda reading: replace(reading, reason="so " * 350_000)),
    "very_long_prose": Fault(write=lambda content: "so " * 350_000 + content),
    "control_characters": Fault(read=lambda reading: replace(reading, reason=CONTROL)),
    "raw_control_characters": Fault(write=lambda content: content.replace("asks", "asks\n\t\x07")),
}
"""Every row of the specification's table, and its neighbours."""
