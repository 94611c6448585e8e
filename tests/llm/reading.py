"""Reads a prompt as a model would, and answers from it alone: what is allowed, which pairs are to be ordered."""

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

ACTIONS = ("SLOWER", "IDLE", "HOLD", "FASTER", "LANE_LEFT", "LANE_RIGHT")

_ALLOWED = re.compile(r"^\W*Allowed actions:[ \t]*(.+)$", re.MULTILINE)
_PAIRS = re.compile(r"^\W*Pairs to order:[^\n]*\n((?:[ \t]*\n|[ \t]*- .*\n?|[ \t]+.*\n?)*)", re.MULTILINE)
_PAIR = re.compile(r"^[ \t]*- ([^:\n]+): ([\w.-]+?) and ([\w.-]+)(.*(?:\n[ \t]+(?!- ).*)*)", re.MULTILINE)
_SUGGESTED = re.compile(r"(?:suggested|agreed)\W+([\w-]+)", re.IGNORECASE)
_EARLIEST = re.compile(r"^[ \t]*- ([\w.-]+):.*\bearliest (-?\d+(?:\.\d+)?) s\b", re.MULTILINE)
_SECONDS = re.compile(r"(-?\d+(?:\.\d+)?) ?s\b")
_TARGETS = re.compile(r"^[ \t]*- ([A-Z_, ]+) to (\d+(?:\.\d+)?) m/s(.*)$", re.MULTILINE)
_LEAVES = re.compile(r"^[ \t]*- ([\w.-]+).*\bzone (?:from [\d.]+ s to|until) (\d+(?:\.\d+)?) s", re.MULTILINE)
_BEFORE = re.compile(r"^[ \t]*- ([\w.-]+) before you\b", re.MULTILINE)
_ZONE = re.compile(r"([\w.-]+)'s(?: zone)? in (\d+(?:\.\d+)?) s")
_JUDGED = re.compile(r"^(\S+): would \S+ let \S+ pass first\?[^\n]*\n- ([^\n]*)\n- ([^\n]*)$", re.MULTILINE)
_THERE = re.compile(r"there in (\d+(?:\.\d+)?) s\b")
_GETS = re.compile(r"^[ \t]*- ([A-Z_, ]+):.*\bgets (-?\d+(?:\.\d+)?) m\b", re.MULTILINE)


@dataclass(frozen=True, slots=True)
class Pair:
    """Two vehicles that are to be ordered.

    Attributes:
        id: How the prompt calls the pair.
        first: Who is to go first.
        second: Who waits.
    """

    id: str
    first: str
    second: str

    def turned(self) -> "Pair":
        """The other order."""
        return replace(self, first=self.second, second=self.first)


@dataclass(frozen=True, slots=True)
class Reading:
    """What the prompt asks for, and the answer to it before it takes a form.

    Attributes:
        action: The decision; empty if none is asked for.
        allowed: The actions that the prompt allows.
        pairs: The order of each pair that the prompt lists.
        chances: How likely it is that a driver lets a CAV pass, by the pair that the prompt lists.
        reason: One sentence.
    """

    action: str = ""
    allowed: tuple[str, ...] = ()
    pairs: tuple[Pair, ...] = ()
    chances: Mapping[str, float] = field(default_factory=dict)
    reason: str = "That is what the situation asks for."


def read(messages: Sequence[dict[str, Any]]) -> Reading:
    """Read what is asked, from the last user message that asks for something.

    Args:
        messages: The conversation as it was sent.

    Returns:
        The answer; empty if nothing is asked that is understood.
    """
    for message in reversed(messages):
        text = str(message.get("content") or "")
        if message.get("role") != "user":
            continue
        if judged := _JUDGED.findall(text):
            return Reading(chances={name: _chance(mine, its) for name, mine, its in judged})
        if found := _PAIRS.search(text):
            earliest = {name: float(time) for name, time in _EARLIEST.findall(text)}
            return Reading(pairs=tuple(_pairs(found.group(1), earliest)))
        if found := _ALLOWED.search(text):
            allowed = tuple(word for word in re.findall(r"[A-Z_]+", found.group(1)) if word in ACTIONS)
            return Reading(action=_chosen(text, allowed), allowed=allowed)
    return Reading()


def _chance(mine: str, its: str) -> float:
    """Likely where the driver stands, or would be there more than a second later than the CAV at its earliest."""
    cav, human = _THERE.search(mine), _THERE.search(its)
    later = cav is None or human is None or float(human.group(1)) > float(cav.group(1)) + 1.0
    return 0.9 if later else 0.1


def _chosen(text: str, allowed: Sequence[str]) -> str:
    """The allowed action that is said to get farthest; without metres the fastest that lets those before it leave."""
    if _GETS.search(text) or not _TARGETS.search(text):
        return _farthest(text, allowed)
    leaves, before = {name: float(time) for name, time in _LEAVES.findall(text)}, set(_BEFORE.findall(text))
    worth: dict[str, tuple[bool, float]] = {}
    for names, speed, rest in _TARGETS.findall(text):
        waits = all(float(time) >= leaves.get(name, 0.0) for name, time in _ZONE.findall(rest) if name in before)
        worth |= dict.fromkeys(re.findall("[A-Z_]+", names), (waits, float(speed) if waits else -float(speed)))
    return max(allowed, key=lambda action: worth.get(action, (False, float("-inf"))), default="")


def _farthest(text: str, allowed: Sequence[str]) -> str:
    """The allowed action that is said to get farthest, else the first."""
    metres = {
        action: float(distance) for names, distance in _GETS.findall(text) for action in re.findall("[A-Z_]+", names)
    }
    return max(allowed, key=lambda action: metres.get(action, float("-inf")), default="")


def _pairs(text: str, earliest: dict[str, float]) -> Iterator[Pair]:
    for found in _PAIR.finditer(text):
        name, one, other, rest = found.groups()
        pair = Pair(name.strip(), one, other)
        yield pair if _goes_first(one, other, rest, earliest) == one else pair.turned()


def _goes_first(one: str, other: str, rest: str, earliest: dict[str, float]) -> str:
    """Who is suggested or agreed on, else who can be there or is said to arrive first, else who is named first."""
    if (found := _SUGGESTED.search(rest)) and found.group(1) in (one, other):
        return found.group(1)
    times = {name: earliest[name] for name in (one, other) if name in earliest}
    parts = re.split(rf"\b({re.escape(one)}|{re.escape(other)})\b", rest)
    for name, words in zip(parts[1::2], parts[2::2], strict=True):
        if number := _SECONDS.search(words):
            times.setdefault(name, float(number.group(1)))
    return other if times.get(other, float("inf")) < times.get(one, float("inf")) else one


def schema_of(body: dict[str, Any]) -> dict[str, Any]:
    """Find the form that the answer must have: in the request's own field, else written out in a message.

    Args:
        body: The request.

    Returns:
        A JSON schema; empty if there is none.
    """
    asked = body.get("response_format") or {}
    if asked.get("type") == "json_schema":
        return dict(asked["json_schema"]["schema"])
    decoder = json.JSONDecoder()
    for message in body.get("messages", ()):
        text = str(message.get("content") or "")
        for begin in (found.start() for found in re.finditer(r"\{", text)):
            try:
                value, _ = decoder.raw_decode(text, begin)
            except ValueError:
                continue
            if isinstance(value, dict) and "properties" in value:
                return value
    return {}


def answer(reading: Reading, schema: dict[str, Any]) -> dict[str, Any]:
    """Put the answer into its form.

    Args:
        reading: The answer.
        schema: The form; without one, the usual.
    """
    if schema:
        return dict(_fill(schema, "", reading, None, schema.get("$defs", {})))
    if reading.pairs:
        return {"orders": [{"pair": p.id, "first": p.first, "reason": reading.reason} for p in reading.pairs]}
    return {"reason": reading.reason, "action": reading.action}


def _fill(node: dict[str, Any], name: str, reading: Reading, pair: Pair | None, defs: dict[str, Any]) -> Any:
    """Fill one place of a form by what it is called and which values it takes."""
    while "$ref" in node:
        node = defs[node["$ref"].rsplit("/", 1)[-1]]
    if "anyOf" in node:
        node = next(option for option in node["anyOf"] if option.get("type") != "null")
        return _fill(node, name, reading, pair, defs)
    by_id = {p.id: p for p in reading.pairs}
    if node.get("type") == "object" or "properties" in node:
        inner = pair or by_id.get(name)
        return {key: _fill(item, key, reading, inner, defs) for key, item in node.get("properties", {}).items()}
    if node.get("type") == "array":
        return [_fill(node["items"], name, reading, p, defs) for p in reading.pairs]
    values = node.get("enum") or ([node["const"]] if "const" in node else [])
    return _word(name, values, reading, pair or by_id.get(name))


def _word(name: str, values: Sequence[Any], reading: Reading, pair: Pair | None) -> Any:
    """One word of an answer."""
    if name == "action":
        return reading.action
    if name in reading.chances:
        return reading.chances[name]
    if pair is not None:
        if name in ("pair", "id", "pair_id"):
            return pair.id
        if name in ("second", "waits", "yields"):
            return pair.second
        if name in ("first", pair.id) or pair.first in values:
            return pair.first
    return values[0] if values else reading.reason
