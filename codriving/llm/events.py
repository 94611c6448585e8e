"""A chat completion out of the events of a server that sends it bit by bit."""

import json
from collections.abc import Iterable, Mapping
from contextlib import suppress
from typing import Any

from codriving.llm.faults import CallError, FaultKind


def completion_of(text: str) -> bytes:
    """Put the events of a stream together to the body that would have been sent at once."""
    return json.dumps(joined(_events(text), "data: [DONE]" in text)).encode()


def joined(events: Iterable[Mapping[str, Any]], done: bool = False) -> dict[str, Any]:
    """Put events together to one chat completion, or to the error that one of them tells.

    Args:
        done: Whether the stream said that it is at its end.
    """
    whole: dict[str, Any] = {"object": "chat.completion"}
    message: dict[str, Any] = {"role": "assistant", "content": ""}
    ended = None
    for event in events:
        if event.get("error"):
            return {"error": event["error"]}
        whole |= {name: event[name] for name in ("id", "created", "model", "usage") if event.get(name) is not None}
        choices = event.get("choices")
        choice = choices[0] if isinstance(choices, list) and choices and isinstance(choices[0], dict) else {}
        said = choice.get("delta") or choice.get("message")
        _add(message, said if isinstance(said, dict) else {})
        ended = choice.get("finish_reason") or ended
    if ended is None and not done:
        raise CallError(FaultKind.DROPPED, "the stream broke off")
    return {**whole, "choices": [{"index": 0, "finish_reason": ended or "stop", "message": message}]}


def _events(text: str) -> list[dict[str, Any]]:
    found = []
    for line in text.splitlines():
        with suppress(ValueError, RecursionError):
            event = json.loads(line.removeprefix("data:")) if line.startswith("data:") else None
            found += [event] if isinstance(event, dict) else []
    return found


def _add(message: dict[str, Any], delta: dict[str, Any]) -> None:
    for name, value in delta.items():
        if name == "role":
            continue
        if isinstance(value, str):
            message[name] = (message.get(name) or "") + value
        elif name == "tool_calls" and isinstance(value, list):
            for call in (one for one in value if isinstance(one, dict)):
                _add_call(message.setdefault(name, []), call)


def _add_call(calls: list[dict[str, Any]], call: dict[str, Any]) -> None:
    """Tool calls come in pieces, too, each with the number of its call."""
    at, function = call.get("index", 0), call.get("function")
    known = next((one for one in calls if one["index"] == at), None)
    if known is None:
        known = {"index": at, "id": call.get("id") or f"call_{at}", "type": "function"}
        known["function"] = {"name": "", "arguments": ""}
        calls.append(known)
    for name, value in function.items() if isinstance(function, dict) else ():
        if isinstance(value, str):
            known["function"][name] = known["function"].get(name, "") + value
