"""A line of ``decisions.jsonl`` as far as a picture shows it; another method may have written something else."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from codriving.animation.moment import Meeting, Thought
from codriving.datatypes.action import Action
from codriving.datatypes.conflict import Relation, Severity
from codriving.geometry.road_map import RoadMap

_ORDERS = {True: "Passing order, binding", False: "Passing order"}


@dataclass(frozen=True, slots=True)
class Deliberated:
    """What was decided in one step.

    Attributes:
        time: When [s].
        order: The passing order that all share, or None.
    """

    time: float
    thoughts: Mapping[str, Thought] = field(default_factory=dict)
    routes: Mapping[str, str] = field(default_factory=dict)
    meetings: tuple[Meeting, ...] = ()
    order: tuple[str, ...] | None = None
    order_title: str = ""


def deliberated(line: Mapping[str, Any], road_map: RoadMap) -> Deliberated:
    """Read a line."""
    cavs = {name: entry for entry in _maps(line, "cavs") if (name := _text(entry, "id"))}
    order, title = _order([_map(entry, "order") for entry in cavs.values()])
    routes = {name: _text(_map(_map(entry, "scene"), "intent"), "route") for name, entry in cavs.items()}
    return Deliberated(
        time=_number(line, "time") or 0.0,
        thoughts={name: _thought(name, entry) for name, entry in cavs.items()},
        routes={name: route for name, route in routes.items() if route},
        meetings=_meetings(cavs.values(), road_map),
        order=order,
        order_title=title,
    )


def action_named(name: str) -> Action | None:
    """Return an action by its name, or None if it is not one."""
    return Action(name) if name in {str(action) for action in Action} else None


def _text(entry: Mapping[str, Any], key: str) -> str:
    value = entry.get(key)
    return value if isinstance(value, str) else ""


def _number(entry: Mapping[str, Any], key: str) -> float | None:
    value = entry.get(key)
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else None


def _map(entry: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    value = entry.get(key)
    return value if isinstance(value, Mapping) else {}


def _maps(entry: Mapping[str, Any], key: str) -> list[Mapping[str, Any]]:
    return [value for value in _list(entry, key) if isinstance(value, Mapping)]


def _texts(entry: Mapping[str, Any], key: str) -> tuple[str, ...]:
    return tuple(value for value in _list(entry, key) if isinstance(value, str))


def _list(entry: Mapping[str, Any], key: str) -> Sequence[Any]:
    value = entry.get(key)
    return value if isinstance(value, list | tuple) else ()


def _thought(name: str, entry: Mapping[str, Any]) -> Thought:
    pairs = _maps(_map(entry, "order"), "precedences")
    firsts = dict.fromkeys(_text(pair, "first") for pair in pairs if _text(pair, "second") == name)
    return Thought(action_named(_text(entry, "action")), _text(entry, "reason"), tuple(filter(None, firsts)))


def _order(orders: Sequence[Mapping[str, Any]]) -> tuple[tuple[str, ...] | None, str]:
    sequences = [_texts(order, "sequence") for order in orders]
    if not any(sequences):
        return None, ""
    if len(set(sequences)) > 1:
        return None, "No common order: every CAV makes up its own"
    return sequences[0], "Passing order, binding" if orders[0].get("binding") is True else "Passing order"


def _meetings(entries: Iterable[Mapping[str, Any]], road_map: RoadMap) -> tuple[Meeting, ...]:
    worst: dict[frozenset[str], Meeting] = {}
    for conflict in (c for entry in entries for c in _maps(entry, "conflicts")):
        meeting = _meeting(conflict, road_map)
        if meeting is None:
            continue
        pair = frozenset((meeting.one, meeting.other))
        if pair not in worst or meeting.dttcp < worst[pair].dttcp:
            worst[pair] = meeting
    return tuple(worst.values())


def _meeting(conflict: Mapping[str, Any], road_map: RoadMap) -> Meeting | None:
    one, other, dttcp = _text(conflict, "ego"), _text(conflict, "other"), _number(conflict, "dttcp")
    severity = _text(conflict, "severity")
    if not one or not other or dttcp is None or severity not in {str(band) for band in Severity}:
        return None
    certain = conflict.get("certain") is not False
    return Meeting(one, other, Severity(severity), dttcp, certain, _ways(conflict, road_map))


def _ways(conflict: Mapping[str, Any], road_map: RoadMap) -> tuple[tuple[str, float], tuple[str, float]] | None:
    """Where the centre lines cross or come together; one behind the other meet nowhere on the map."""
    routes, index = _texts(conflict, "routes"), conflict.get("zone")
    if conflict.get("relation") == Relation.FOLLOWING or len(routes) != 2 or not isinstance(index, int):
        return None
    one, other = routes
    if not {one, other} <= set(road_map.routes):
        return None
    zones = road_map.zones(one, other)
    if not 0 <= index < len(zones):
        return None
    zone = zones[index]
    at_one = zone.point_i if zone.merge_i is None else zone.merge_i
    at_other = zone.point_j if zone.merge_j is None else zone.merge_j
    return (one, at_one), (other, at_other)
