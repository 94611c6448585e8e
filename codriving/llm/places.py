"""The places of a message where an answer may stand, whichever server wrote it."""

import json
from collections.abc import Iterator, Mapping
from typing import Any

_OWN = ("reasoning_content", "reasoning", "thinking", "reasoning_details", "thinking_blocks")
_SPECIFIC = "provider_specific_fields"
_NO_PLACES = ("role", "refusal", "function_call", "name", "id", "type", "annotations", "citations", _SPECIFIC)
_THOUGHTS = ("thinking", "reasoning", "thought", "redacted_thinking")  # Types of parts that are not meant for the user


def places_of(message: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Give name and text of each place of a message that holds a text, in the order in which they are read."""
    content, thoughts, calls = message.get("content"), [], []
    parts = content if isinstance(content, list) else [content]
    said = ""
    for part in parts:
        kind = part.get("type") if isinstance(part, dict) else ""
        if kind in _THOUGHTS:
            thoughts.append(_text(part))
        elif kind in ("tool_use", "tool_call", "function_call"):
            calls.append(_text(part, ("input", "arguments")))
        elif kind == "refusal":
            yield "refusal", _text(part)
        else:
            said += _text(part)
    beside = message.get(_SPECIFIC)
    beside = beside if isinstance(beside, dict) else {}
    if refusal := _text(message.get("refusal")) or _text(beside.get("refusal")):
        yield "refusal", refusal
    for call in [*(message.get("tool_calls") or ()), {"function": message.get("function_call")}]:
        function = call.get("function") if isinstance(call, dict) else None
        calls.append(_text(function.get("arguments")) if isinstance(function, dict) else "")
    texts = {"content": said, "tool_calls": "\n".join(filter(None, calls))}
    texts |= {name: _text(message.get(name)) for name in _OWN} | {"parts": "\n".join(thoughts)}
    # What a server calls otherwise is read last, and so is what LiteLLM puts into a place of its own.
    others = {**message, **{f"own {name}": value for name, value in beside.items()}}
    for name in [name for name in others if name not in texts and name.removeprefix("own ") not in _NO_PLACES]:
        if "{" in (text := _text(others[name])):
            texts[name] = text
    yield from ((name, text) for name, text in texts.items() if text.strip())


_KEYS = ("text", "value", "content", "refusal", "thinking", "reasoning", "summary", "json", "output", "parts")


def _text(node: Any, keys: tuple[str, ...] = _KEYS) -> str:  # noqa: ANN401 - any JSON
    """Return the text of a place: a text, parts of which one key holds the text, or an object that is the answer."""
    if isinstance(node, str):
        return node
    if isinstance(node, list):
        return "".join(_text(inner) for inner in node)
    if not isinstance(node, dict):
        return ""
    for key in keys:
        if key in node and ("type" in node or len(node) == 1):
            return _text(node[key], keys)
    return "" if "type" in node else json.dumps(node)
