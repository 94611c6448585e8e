"""What a CAV knew, was asked and decided at one step, as titles, tables and texts that a page shows as they are."""

import json
from collections.abc import Iterable, Mapping, Sequence
from math import hypot
from typing import Any, TypeAlias

from codriving.animation import list_in, map_in, maps_in, number_in, text_in, texts_in

Section: TypeAlias = dict[str, Any]  # Title ``h``, sentences ``p``, a table of ``c`` and ``r``, long texts ``t``

Entry: TypeAlias = Mapping[str, Any]

KNOWN = {
    *("id", "action", "reason", "scene", "conflicts", "order", "allowed", "removed", "assessments", "memories"),
    *("similarities", "recalled", "judgements", "agreements", "filter"),
}


def sections(entry: Entry, said: Sequence[Entry], asked: Sequence[Entry]) -> list[Section]:
    """Say what a decision was made of.

    Args:
        entry: What ``decisions.jsonl`` says of a CAV at one step.
        said: The messages about orders since the step before.
        asked: The lines of ``transcript.jsonl`` of this step that concern it.
    """
    name = text_in(entry, "id")
    found = [
        _actions(entry),
        _removed(entry),
        _filter(entry),
        _order(name, entry),
        _humans(name, entry),
        _conflicts(entry),
        _knew(entry),
        _memories(entry),
        _messages(name, entry, said),
        *map(_question, asked),
        _others(entry),
    ]
    return [section for section in found if section is not None]


def section(
    title: str,
    sentences: Iterable[str] = (),
    heads: Sequence[str] = (),
    rows: Sequence[Sequence[str]] = (),
    texts: Sequence[tuple[str, str]] = (),
) -> Section | None:
    """Make a section of what there is; None of nothing."""
    parts = {"p": [s for s in sentences if s], "r": [list(row) for row in rows], "t": [list(text) for text in texts]}
    held = {key: value for key, value in parts.items() if value}
    return {"h": title, **held, **({"c": list(heads)} if rows else {})} if held else None


def _actions(entry: Entry) -> Section | None:
    """What could be done, and what was taken."""
    removed, taken = map_in(entry, "removed"), text_in(entry, "action")
    assessed = {text_in(one, "action"): one for one in maps_in(entry, "assessments")}
    rows = []
    for action in dict.fromkeys([*assessed, *texts_in(entry, "allowed"), *removed]):
        one = assessed.get(action, {})
        verdict = "removed" if action in removed else "allowed"
        if action == taken:
            verdict = "taken" if action not in removed else "taken though removed"
        times = ", ".join(f"{t:.1f}" for t in list_in(one, "arrivals") if isinstance(t, int | float))
        rows.append((action, verdict, _with(one, "target", "m/s", 1), _with(one, "progress", "m"), times))
    return _table("Actions", ("action", "verdict", "target", "gets", "earliest at zones [s]"), rows)


def _removed(entry: Entry) -> Section | None:
    removed = map_in(entry, "removed")
    rows = [(action, "; ".join(texts_in(removed, action))) for action in removed]
    return section("Removed actions", heads=("action", "why not"), rows=rows)


def _filter(entry: Entry) -> Section | None:
    checked = map_in(entry, "filter")
    rows = [(action, "; ".join(texts_in(map_in(checked, "removed"), action))) for action in map_in(checked, "removed")]
    wanted, taken = text_in(checked, "wanted"), text_in(checked, "taken")
    words = f"The method wanted {wanted}; {taken} was driven." if wanted != taken else f"{wanted} passed the check."
    return section("Safety check behind the method", [words] if checked else [], ("action", "why not"), rows)


def _order(name: str, entry: Entry) -> Section | None:
    order = map_in(entry, "order")
    pairs = maps_in(order, "precedences")
    people = _people(entry)
    pairs = [pair for pair in pairs if not _judged(name, people, pair)]
    own = [pair for pair in pairs if name in (text_in(pair, "first"), text_in(pair, "second"))]
    rows = [
        (text_in(pair, "first"), text_in(pair, "second"), text_in(pair, "reason"))
        for pair in [*own, *(pair for pair in pairs if pair not in own)]
    ]
    sequence = texts_in(order, "sequence")
    kind = "The order binds." if order.get("binding") is True else "The order is advice."
    words = [", then ".join(sequence) + ".", kind] if sequence else []
    return section("Passing order", words, ("first", "second", "why"), rows)


def _humans(name: str, entry: Entry) -> Section | None:
    """How human drivers that meet this CAV are judged: by who was asked for it, and by what the order says of them."""
    people, judged = _people(entry), map_in(entry, "judgements")
    rows = []
    for driver in judged:
        one = map_in(judged, driver)
        share = number_in(one, "yields")
        likely = "" if share is None else f", lets it pass with {100 * share:.0f} %"
        rows.append((driver, f"{text_in(one, 'answer')}{likely}", text_in(one, "reason")))
    for pair in maps_in(map_in(entry, "order"), "precedences"):
        if _judged(name, people, pair):
            first, second, why = (text_in(pair, key) for key in ("first", "second", "reason"))
            rows.append((first, "goes first", why) if first in people else (second, "gives way", why))
    return section("Judgement of human drivers", heads=("driver", "verdict", "why"), rows=rows)


def _people(entry: Entry) -> set[str]:
    """The human drivers that it knew of."""
    return {text_in(n, "id") for n in maps_in(map_in(entry, "scene"), "neighbours") if text_in(n, "kind") == "HDV"}


def _judged(name: str, people: set[str], pair: Entry) -> bool:
    """Whether a pair of the order is of this CAV and a human driver."""
    both = {text_in(pair, "first"), text_in(pair, "second")}
    return name in both and bool(both & people)


def _conflicts(entry: Entry) -> Section | None:
    heads = ("with", "kind", "danger", "dTTCP", "TTCP, own and other", "their route", "free")
    rows = []
    for conflict in maps_in(entry, "conflicts"):
        times = " and ".join(f"{t:.1f}" for t in list_in(conflict, "ttcp") if isinstance(t, int | float))
        clear = number_in(conflict, "clear_time")
        free = "goes first" if clear == 0 else f"in {clear:.1f} s" if clear is not None else "not within 10 s"
        routes = texts_in(conflict, "routes")
        guess = "" if conflict.get("certain") is not False else " (a guess)"
        rows.append(
            (
                text_in(conflict, "other"),
                text_in(conflict, "relation"),
                text_in(conflict, "severity"),
                _with(conflict, "dttcp", "s", 1),
                f"{times} s" if times else "",
                (routes[1] if len(routes) > 1 else "") + guess,
                free if "clear_time" in conflict else "",
            )
        )
    return _table("Conflicts", heads, rows)


def _knew(entry: Entry) -> Section | None:
    """Its own state and intent, and of each neighbour what it knew of it, and from where."""
    scene = map_in(entry, "scene")
    ego = map_in(scene, "ego")
    plan = _plan(map_in(scene, "intent"))
    own = [f"Itself at {_with(ego, 'speed', 'm/s', 1)}{', ' if plan else ''}{plan}."] if ego else []
    change = scene.get("must_change")
    own += [f"It has to change lanes: {json.dumps(change)}."] if change else []
    heads = ("vehicle", "where", "away", "gap", "speed", "intent, or possible routes", "known by")
    rows = [_neighbour(ego, neighbour) for neighbour in maps_in(scene, "neighbours")]
    found = _table("What it knew", heads, rows)
    return {**found, "p": own} if found else section("What it knew", own)


def _neighbour(ego: Entry, neighbour: Entry) -> tuple[str, ...]:
    places = [(number_in(one, "x"), number_in(one, "y")) for one in (ego, neighbour)]
    (x, y), (a, b) = places
    away = "" if x is None or y is None or a is None or b is None else f"{hypot(a - x, b - y):.0f} m"
    plan = _plan(map_in(neighbour, "intent"))
    if not plan:
        plan = " or ".join(str(route[0]) for route in list_in(neighbour, "routes") if isinstance(route, list) and route)
        plan = f"not known; {plan}" if plan else "not known"
    told = map_in(neighbour, "told")
    known = "" if neighbour.get("told", False) is False else "its own sensors"
    if told:
        ages = [f"a message {_with(told, 'age', 's', 1)} old" if number_in(told, "age") is not None else ""]
        ages += [
            f"its intent {_with(told, 'intent_age', 's', 1)} old" if number_in(told, "intent_age") is not None else ""
        ]
        ages += ["seen, too" if told.get("seen") is True else ""]
        known = ", ".join(filter(None, ages))
    return (
        text_in(neighbour, "id"),
        text_in(neighbour, "role"),
        away,
        _with(neighbour, "gap", "m"),
        _with(neighbour, "speed", "m/s", 1),
        plan,
        known,
    )


def _plan(intent: Entry) -> str:
    route, speed = text_in(intent, "route"), _with(intent, "target_speed", "m/s", 1)
    return ", ".join(filter(None, (route, speed and f"target {speed}")))


def _memories(entry: Entry) -> Section | None:
    how_like = list_in(entry, "similarities")
    rows = [
        (f"{how_like[k]:.2f}" if k < len(how_like) and isinstance(how_like[k], int | float) else "", str(memory))
        for k, memory in enumerate(list_in(entry, "memories"))
    ]
    changed = (
        [f"The decision was changed by memory {', '.join(map(str, ids))}."]
        if (ids := list_in(entry, "recalled"))
        else []
    )
    return section("Recalled memories", changed, ("similarity", "memory"), rows)


def _messages(name: str, entry: Entry, said: Sequence[Entry]) -> Section | None:
    """What it said and was told since the step before, and what it holds."""
    rows = []
    for message in said:
        arrives = map_in(message, "arrives")
        if name not in (text_in(message, "sender"), *arrives):
            continue
        to = ", ".join(
            f"{who} at {at:.1f} s" if isinstance(at, int | float) else str(who) for who, at in arrives.items()
        )
        rows.append((text_in(message, "sender"), text_in(message, "kind"), to or "nowhere: lost", _pairs(message)))
    held = [
        f"It holds {'an instruction' if text_in(one, 'authority') else 'the agreement'} of {text_in(one, 'sender')}"
        f"{f' ({a})' if (a := text_in(one, 'authority')) else ''} until {_with(one, 'until', 's', 1)}: {_pairs(one)}."
        for one in maps_in(entry, "agreements")
    ]
    return section("Messages about orders", held, ("from", "message", "arrives", "says"), rows)


def _pairs(message: Entry) -> str:
    pairs = [pair for pair in list_in(message, "pairs") if isinstance(pair, list) and len(pair) > 1]
    return "; ".join(
        f"{pair[0]} before {pair[1]}" + (f" ({pair[2]})" if len(pair) > 2 and pair[2] else "") for pair in pairs
    )


def _question(line: Entry) -> Section | None:
    """What a model was asked and what it answered, attempt by attempt."""
    subject = text_in(line, "subject")
    purpose = text_in(line, "purpose") or "question"
    texts, words = [], []
    for call in maps_in(line, "calls"):
        texts += [(text_in(message, "role"), text_in(message, "content")) for message in maps_in(call, "messages")]
        texts.append(("answer", text_in(call, "text")))
        counted = [
            f"{int(n):,} {what}" for what in ("prompt", "completion") if (n := number_in(call, f"{what}_tokens"))
        ]
        cost = [
            _with(call, "seconds", "s", 2),
            f"{' + '.join(counted)} tokens" if counted else "",
            text_in(call, "problem"),
        ]
        words.append(", ".join(filter(None, cost)) + ".")
    if not texts:
        return None
    value = line.get("value")
    read = "Nothing could be read in the answer: a fallback was used." if value is None else ""
    problem = f"Problem: {text_in(line, 'problem')}." if text_in(line, "problem") else ""
    mended = "The form of the answer was mended." if line.get("mended") is True else ""
    title = f"The model was asked: {purpose}{'' if subject else ', for all'}"
    return section(title, [*words, read, problem, mended], texts=texts)


def _others(entry: Entry) -> Section | None:
    """What a method of its own kind has written besides."""
    texts = [(key, json.dumps(value, indent=1, ensure_ascii=False)) for key, value in entry.items() if key not in KNOWN]
    return section("Further notes of the method", texts=texts)


def _table(title: str, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> Section | None:
    """A table without the columns in which there is nothing."""
    kept = [k for k in range(len(heads)) if any(row[k] for row in rows)]
    return section(title, heads=[heads[k] for k in kept], rows=[[row[k] for k in kept] for row in rows])


def _with(entry: Entry, key: str, unit: str, digits: int = 0) -> str:
    value = number_in(entry, key)
    return "" if value is None else f"{value:.{digits}f} {unit}"
