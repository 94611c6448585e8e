"""What a frame shows, as plain data, and how it is read from a stored episode at any time."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from codriving.animation.reading import map_in, maps_in, number_in, text_in, texts_in
from codriving.animation.talk import Talk
from codriving.datatypes import Action, Kind, Outcome, Relation, Severity, Track, Trajectory
from codriving.geometry import RoadMap


@dataclass(frozen=True, slots=True)
class DrawnVehicle:
    """A vehicle on the road."""

    id: str
    kind: Kind
    x: float  # Position [m]
    y: float  # Position [m]
    heading: float  # Heading [rad]
    speed: float  # Speed [m/s]
    route: str | None = None  # Id of the planned route; None for a human driver
    length: float = 5.0  # Length [m]
    width: float = 2.0  # Width [m]


@dataclass(frozen=True, slots=True)
class DrawnConflict:
    """An open conflict between two vehicles."""

    one: str
    other: str
    severity: Severity
    dttcp: float  # The time difference [s]
    certain: bool
    # Route of each, with the arc length at which it comes to where they would meet [m]; None if that is not known.
    ways: tuple[tuple[str, float], tuple[str, float]] | None = None


@dataclass(frozen=True, slots=True)
class DrawnDecision:
    """What a CAV decided."""

    action: Action | None
    reason: str = ""
    waits_for: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class FrameContent:
    """One moment of an episode."""

    time: float  # Simulated time [s]
    bodies: tuple[DrawnVehicle, ...] = ()
    thoughts: Mapping[str, DrawnDecision] = field(default_factory=dict)
    meetings: tuple[DrawnConflict, ...] = ()
    order: tuple[str, ...] | None = None  # The passing order, first to last; None if there is none that all share
    order_title: str = ""
    # Arrival time of each CAV that has arrived [s], by id; None if it is not known when.
    arrived: Mapping[str, float | None] = field(default_factory=dict)
    outcome: Outcome | None = None
    routes: Mapping[str, str] = field(default_factory=dict)
    talk: tuple[str, ...] = ()  # Who proposed an order, who accepted it and who holds it


def deliberated(line: Mapping[str, Any], road_map: RoadMap) -> FrameContent:
    """Read a line."""
    cavs = {name: entry for entry in maps_in(line, "cavs") if (name := text_in(entry, "id"))}
    order, title = _order(list(cavs.values()))
    routes = {name: text_in(map_in(map_in(entry, "scene"), "intent"), "route") for name, entry in cavs.items()}
    return FrameContent(
        time=number_in(line, "time") or 0.0,
        thoughts={name: _thought(name, entry) for name, entry in cavs.items()},
        routes={name: route for name, route in routes.items() if route},
        meetings=_meetings(cavs.values(), road_map),
        order=order,
        order_title=title,
    )


def action_named(name: str) -> Action | None:
    """Return an action by its name, or None if it is not one."""
    return Action(name) if name in {str(action) for action in Action} else None


def _thought(name: str, entry: Mapping[str, Any]) -> DrawnDecision:
    pairs = maps_in(map_in(entry, "order"), "precedences")
    firsts = dict.fromkeys(text_in(pair, "first") for pair in pairs if text_in(pair, "second") == name)
    return DrawnDecision(action_named(text_in(entry, "action")), text_in(entry, "reason"), tuple(filter(None, firsts)))


def _order(entries: Sequence[Mapping[str, Any]]) -> tuple[tuple[str, ...] | None, str]:
    orders = [map_in(entry, "order") for entry in entries]
    sequences = [texts_in(order, "sequence") for order in orders]
    if not any(sequences):
        return None, ""
    if len(set(sequences)) > 1:
        if any("agreements" in entry for entry in entries):
            return None, "Orders differ: every CAV goes by what has reached it"
        return None, "No common order: every CAV makes up its own"
    return sequences[0], "Passing order, binding" if orders[0].get("binding") is True else "Passing order"


def _meetings(entries: Iterable[Mapping[str, Any]], road_map: RoadMap) -> tuple[DrawnConflict, ...]:
    worst: dict[frozenset[str], DrawnConflict] = {}
    for meeting in (_meeting(conflict, road_map) for entry in entries for conflict in maps_in(entry, "conflicts")):
        if meeting is not None:
            pair = frozenset((meeting.one, meeting.other))
            if pair not in worst or meeting.dttcp < worst[pair].dttcp:
                worst[pair] = meeting
    return tuple(worst.values())


def _meeting(conflict: Mapping[str, Any], road_map: RoadMap) -> DrawnConflict | None:
    one, other, dttcp = text_in(conflict, "ego"), text_in(conflict, "other"), number_in(conflict, "dttcp")
    severity = text_in(conflict, "severity")
    if not one or not other or dttcp is None or severity not in {str(band) for band in Severity}:
        return None
    certain = conflict.get("certain") is not False
    return DrawnConflict(one, other, Severity(severity), dttcp, certain, _ways(conflict, road_map))


def _ways(conflict: Mapping[str, Any], road_map: RoadMap) -> tuple[tuple[str, float], tuple[str, float]] | None:
    """Where the centre lines cross or come together; one behind the other meet nowhere on the map."""
    routes, index = texts_in(conflict, "routes"), conflict.get("zone")
    if conflict.get("relation") == Relation.FOLLOWING or len(routes) != 2 or not isinstance(index, int):
        return None
    one, other = routes
    zones = road_map.zones(one, other) if {one, other} <= set(road_map.routes) else ()
    if not 0 <= index < len(zones):
        return None
    zone = zones[index]
    at_one = zone.point_i if zone.merge_i is None else zone.merge_i
    return (one, at_one), (other, zone.point_j if zone.merge_j is None else zone.merge_j)


class StoredFrames:
    """The moments of one episode.

    Attributes:
        duration: Time from the first row to the last [s].
    """

    def __init__(
        self, road_map: RoadMap, trajectory: Trajectory, decisions: Sequence[Mapping[str, Any]], outcome: Outcome
    ) -> None:
        self._trajectory, self._outcome = trajectory, outcome
        self._headings = {track.id: np.unwrap(track.heading) for track in trajectory.tracks}
        talk = Talk()
        self._decided = [replace(deliberated(line, road_map), talk=talk.after(line)) for line in decisions]
        self._times = np.array([d.time for d in self._decided])
        self.duration = max((t.first_step + len(t.x) - 1) * trajectory.step for t in trajectory.tracks)

    def at(self, time: float) -> FrameContent:
        """Return what there was at a moment."""
        time = min(max(time, 0.0), self.duration)
        k = int(np.searchsorted(self._times, time + 1e-6, side="right")) - 1
        decided = self._decided[k] if k >= 0 else FrameContent(time)
        bodies, thoughts = [], dict(decided.thoughts)
        for track in self._trajectory.tracks:
            row = time / self._trajectory.step - track.first_step
            if not -1e-6 <= row <= len(track.x) - 1 + 1e-6:
                continue
            bodies.append(self._body(track, row, decided.routes))
            if track.kind is Kind.CAV and track.id not in thoughts:
                thoughts[track.id] = DrawnDecision(action_named(track.action[min(int(row + 1), len(track.x) - 1)]))
        arrived = {name: at for name, at in self._outcome.arrivals.items() if at <= time + 1e-6}
        outcome = self._outcome if time >= self.duration - 1e-6 else None
        return replace(decided, time=time, bodies=tuple(bodies), thoughts=thoughts, arrived=arrived, outcome=outcome)

    def _body(self, track: Track, row: float, routes: Mapping[str, str]) -> DrawnVehicle:
        k = min(max(int(row), 0), max(len(track.x) - 2, 0))
        share, after = min(max(row - k, 0.0), 1.0), min(k + 1, len(track.x) - 1)

        x, y, heading, speed = (
            float(values[k] + share * (values[after] - values[k]))
            for values in (track.x, track.y, self._headings[track.id], track.speed)
        )
        route = routes.get(track.id, track.route) if track.kind is Kind.CAV else None
        return DrawnVehicle(track.id, track.kind, x, y, heading, speed, route, track.length, track.width)
