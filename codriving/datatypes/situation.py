"""What one CAV knows of the world around it, what a decider is told of that, and all that is decided in one step."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from enum import StrEnum
from functools import lru_cache
from math import cos, hypot, isfinite, sin
from operator import attrgetter
from typing import Any

from codriving.datatypes.experience import Memory
from codriving.datatypes.judgement import Judgement
from codriving.datatypes.order import Conflict, PassingOrder
from codriving.datatypes.outlook import Outlook
from codriving.datatypes.road import LaneId
from codriving.datatypes.world import Action, Intent, Kind, Told, VehicleState


class Role(StrEnum):
    """What a neighbour is to the ego vehicle."""

    LEADING = "leading"
    REARING = "rearing"
    CONFLICT = "conflict"
    OTHER = "other"


@dataclass(frozen=True, slots=True)
class TrackedVehicle:
    """A vehicle as far as the ego vehicle knows it; what it does not know is None."""

    id: str
    kind: Kind | None
    x: float  # [m]
    y: float  # [m]
    speed: float  # [m/s]
    heading: float | None  # [rad]
    acceleration: float | None  # [m/s2]
    lane: LaneId | None
    length: float  # [m]
    # Each route that it may be on, with its arc length there [m]; one entry if it shared its route.
    routes: tuple[tuple[str, float], ...] = ()
    intent: Intent | None = None
    standing: float = 0.0  # How long it has been standing [s]
    role: Role = Role.OTHER
    gap: float | None = None  # Free distance along the ego lane for a leading or rearing vehicle [m]
    told: Told | None = None  # How old and how exact it is if it is known by messages; None where these are exact

    @property
    def is_cav(self) -> bool:
        """Whether it has shared its intent, as only a CAV can."""
        return self.intent is not None

    def in_role(self, role: Role, gap: float | None) -> "TrackedVehicle":
        """Return the same vehicle in a role; `dataclasses.replace` takes five times as long."""
        motion = self.x, self.y, self.speed, self.heading, self.acceleration, self.lane, self.length
        known = self.routes, self.intent, self.standing
        return TrackedVehicle(self.id, self.kind, *motion, *known, role, gap, self.told)

    @property
    def target(self) -> float:
        """Target speed; its speed where that is not known [m/s]."""
        return self.speed if self.intent is None else self.intent.target_speed


@dataclass(frozen=True, slots=True)
class LaneChange:
    """A lane change that the ego vehicle's route asks for."""

    lane: LaneId
    room: float  # Distance within which it has to be begun, since the present lane ends [m]
    action: Action  # LANE_LEFT or LANE_RIGHT, seen from the lane that is then left


@dataclass(frozen=True, slots=True)
class LaneNeighbour:
    """The vehicle next ahead or next behind on an adjacent lane, before its beginning and past its end, too."""

    id: str
    lane: LaneId  # The adjacent lane
    role: Role
    gap: float  # Free distance along the lane [m]


@dataclass(frozen=True, slots=True)
class SceneDescription:
    """The surroundings of one CAV, by lane and by relation."""

    ego: VehicleState
    intent: Intent
    place: float  # Its arc length along its route [m]
    adjacent_lanes: tuple[LaneId, ...]
    conflict_lanes: tuple[LaneId, ...]
    neighbours: tuple[TrackedVehicle, ...]
    # Other routes onto whose lanes its body reaches while it changes lanes, with its arc length there [m].
    covers: tuple[tuple[str, float], ...] = ()
    must_change: LaneChange | None = None  # The lane change that its route asks for next, or None
    beside: tuple[LaneNeighbour, ...] = ()

    @property
    def where(self) -> tuple[str, float]:
        """Its route, and its arc length along it [m]."""
        return self.intent.route, self.place

    def speed_rank(self, action: Action) -> float | None:
        """Rank an action along the lane by how fast it makes the CAV; None for a lane change.

        HOLD is slower than IDLE while the CAV accelerates towards its target speed, and faster while it slows down.
        """
        if action is Action.HOLD:
            speed, target = self.ego.speed, self.intent.target_speed
            return 1.0 + 0.5 * ((speed > target) - (speed < target))
        return {Action.SLOWER: 0.0, Action.IDLE: 1.0, Action.FASTER: 2.0}.get(action)

    def neighbour(self, name: str) -> TrackedVehicle | None:
        """Return a neighbour by id, or None if the ego vehicle does not know of it."""
        return next((n for n in self.neighbours if n.id == name), None)

    def distance(self, n: TrackedVehicle) -> float:
        """Return the distance of the centres [m]."""
        return hypot(n.x - self.ego.x, n.y - self.ego.y)

    def by_distance(self) -> list[TrackedVehicle]:
        """Return the neighbours, nearest first."""
        return sorted(self.neighbours, key=lambda n: (self.distance(n), n.id))

    def offset(self, n: TrackedVehicle) -> tuple[float, float]:
        """Return how far ahead and how far to the right of the ego vehicle a vehicle is [m]."""
        dx, dy, along, across = n.x - self.ego.x, n.y - self.ego.y, cos(self.ego.heading), sin(self.ego.heading)
        return along * dx + across * dy, along * dy - across * dx

    def next_in(self, role: Role) -> TrackedVehicle | None:
        """Return the vehicle that drives next ahead (leading) or behind (rearing) on the lane, or None."""
        return next((n for n in self.neighbours if n.role is role), None)

    def vehicles(self) -> dict[str, TrackedVehicle]:
        """Return the ego vehicle and its neighbours, by id and in the order of the ids."""
        v = self.ego
        routes = ((self.intent.route, self.place), *self.covers)
        ego = TrackedVehicle(
            v.id, v.kind, v.x, v.y, v.speed, v.heading, v.acceleration, v.lane, v.length, routes, self.intent
        )
        return {v.id: v for v in sorted((ego, *self.neighbours), key=lambda v: v.id)}


@dataclass(frozen=True, slots=True)
class ActionAssessment:
    """What the three-layer safety check says of one action."""

    action: Action
    safe: bool
    reasons: tuple[str, ...]
    # Earliest time to reach each conflict zone of the ego vehicle after this action and then full speed [s]; inf if
    # never.
    arrivals: tuple[float, ...]
    # How far the CAV gets within the horizon if it then keeps the order [m]; None if it cannot keep it.
    progress: float | None
    target: float | None = None  # The target speed that it sets [m/s]; None for a lane change, and where none was asked


@dataclass(frozen=True, slots=True)
class Situation:
    """The input of one decision."""

    scene: SceneDescription
    conflicts: tuple[Conflict, ...]
    order: PassingOrder
    # When each conflict zone is expected to be free of those who go first [s]; 0 if the CAV goes first.
    clear_times: tuple[float, ...]
    assessments: tuple[ActionAssessment, ...]
    memories: tuple[Memory, ...] = ()
    # What is expected of human drivers, by id, of whom another than the rules of the road was asked.
    judgements: Mapping[str, Judgement] = field(default_factory=dict)
    outlook: Outlook | None = None  # What a language model is told besides; None where none is asked

    @property
    def allowed(self) -> tuple[Action, ...]:
        """Actions that the safety check left over."""
        return tuple(a.action for a in self.assessments if a.safe)


@dataclass(frozen=True, slots=True)
class Decision:
    """One semantic decision and its reason."""

    ego: str
    action: Action
    reason: str
    recalled: tuple[int, ...] = ()


class Deliberation(ABC):
    """One decision step of a method."""

    # Counters of this step (fallbacks, repaired orders, cost, ...), summed over the episode.
    counts: Mapping[str, float]
    # What a language model was asked, one line of ``transcript.jsonl`` a question.
    transcript: tuple[dict[str, Any], ...] = ()

    @property
    @abstractmethod
    def actions(self) -> dict[str, Action]:
        """The action of each CAV, by id."""

    @abstractmethod
    def as_dict(self) -> dict[str, Any]:
        """Return the step as one JSON-ready line of ``decisions.jsonl``."""


@dataclass(frozen=True, slots=True)
class ReasonedDeliberation(Deliberation):
    """A decision step in which the situation of each CAV is described."""

    time: float  # Simulated time [s]
    step: int
    situations: tuple[Situation, ...]
    decisions: tuple[Decision, ...]
    counts: Mapping[str, float]
    transcript: tuple[dict[str, Any], ...] = ()

    @property
    def actions(self) -> dict[str, Action]:
        return {d.ego: d.action for d in self.decisions}

    def as_dict(self) -> dict[str, Any]:
        # CAVs that go by the same order share its entry.
        written = {key: _order(order) for key, order in {id(s.order): s.order for s in self.situations}.items()}
        return {
            "time": self.time,
            "step": self.step,
            "cavs": [_entry(s, d, written[id(s.order)]) for s, d in zip(self.situations, self.decisions, strict=True)],
        }


def _order(order: PassingOrder) -> dict[str, Any]:
    return {
        "sequence": list(order.sequence),
        "binding": order.binding,
        "precedences": [_plain(p) for p in order.precedences],
    }


def _entry(situation: Situation, decision: Decision, order: dict[str, Any]) -> dict[str, Any]:
    removed = [a for a in situation.assessments if not a.safe]
    return {
        "id": decision.ego,
        "action": str(decision.action),
        "reason": decision.reason,
        "scene": _plain(situation.scene),
        "conflicts": [
            {**_plain(c), "clear_time": _plain(t)}
            for c, t in zip(situation.conflicts, situation.clear_times, strict=True)
        ],
        "order": order,
        "allowed": [str(a) for a in situation.allowed],
        "removed": {str(a.action): list(a.reasons) for a in removed},
        "assessments": [_plain(a) for a in situation.assessments],
        "memories": [memory.text for memory in situation.memories],
        "similarities": [_plain(memory.similarity) for memory in situation.memories],
        "recalled": list(decision.recalled),
        **({"judgements": _plain(dict(situation.judgements))} if situation.judgements else {}),
    }


def _plain(value: Any) -> Any:  # noqa: ANN401 - any JSON value
    """Turn dataclasses into dicts, round floats to a millionth, and turn what is no finite number into None."""
    kind = type(value)
    return value if kind in _KEPT else _WRITERS[kind](value)


# Types of which values are JSON already. A line has a thousand values: most are these or floats, which are therefore
# looked at within the loops below and not one call further.
_KEPT = frozenset({str, int, bool, type(None)})


class _Writers(dict[type, Callable[[Any], Any]]):
    """What makes JSON of a value, by its type."""

    def __missing__(self, kind: type) -> Callable[[Any], Any]:
        write = self[kind] = self._writer(kind)
        return write

    @staticmethod
    def _writer(kind: type) -> Callable[[Any], Any]:
        if issubclass(kind, float):
            return lambda value: round(value, 6) if isfinite(value) else None
        if issubclass(kind, tuple | list):
            return _list
        if kind is TrackedVehicle:
            return _tracked
        if is_dataclass(kind):
            return _record(tuple(f.name for f in fields(kind)))
        if issubclass(kind, dict):
            return lambda value: {k: _plain(v) for k, v in value.items()}
        return str if issubclass(kind, str) else lambda value: value


_WRITERS = _Writers()


def _tracked(vehicle: TrackedVehicle) -> dict[str, Any]:
    """Turn a vehicle into a dict, without ``told`` where messages are exact."""
    written = _TRACKED(vehicle)
    if vehicle.told is None:
        del written["told"]
    return written


@lru_cache(maxsize=1024)
def _rounded(value: float) -> float | None:
    """Round a float; within a step most stand several times, since several CAVs see the same vehicles."""
    return round(value, 6) if isfinite(value) else None


def _list(values: Any) -> list[Any]:  # noqa: ANN401 - a tuple or a list
    return [
        v
        if (kind := type(v)) in _KEPT
        else v and _rounded(v)  # Zeros keep their sign, which no cache could tell
        if kind is float
        else _WRITERS[kind](v)
        for v in values
    ]


def _record(names: tuple[str, ...]) -> Callable[[Any], dict[str, Any]]:
    """Return what makes a dict of a dataclass with fields of these names."""
    # Asked for a single name, an attrgetter returns the bare value.
    read = attrgetter(*names)
    if len(names) == 1:
        return lambda value: {names[0]: _plain(read(value))}

    def write(value: Any) -> dict[str, Any]:  # noqa: ANN401 - any dataclass
        return dict(zip(names, _list(read(value)), strict=True))

    return write


_TRACKED = _record(tuple(f.name for f in fields(TrackedVehicle)))
