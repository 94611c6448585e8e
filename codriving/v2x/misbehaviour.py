"""CAVs that misbehave: which of them do, what false messages they send, and whom one that does not yield minds."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import cos, pi, remainder, sin, tau

from codriving.datatypes import DrivingModel, Intent, Kind, VehicleState, WorldState
from codriving.geometry import RoadMap
from codriving.v2x.draws import MISCONDUCT, stream
from codriving.v2x.messages import (
    CollectivePerception,
    CooperativeAwareness,
    ManoeuvreCoordination,
    PerceivedObject,
    V2xMessage,
)
from codriving.v2x.settings import Misbehaviour

LAP = 8.0  # How long one ghost is told of, before another one is [s]

AHEAD = 25.0  # How far ahead of another CAV, on its route, a ghost begins [m]

PACE = 0.5  # Speed of a ghost, as a share of the highest target speed

ROOM = 20.0  # A ghost is not told of in the last metres of a route [m]

FIRST = 90_000  # Numbers of ghosts, far from those of vehicles

ON, BESIDE = 2.5, 6.0  # Up to here a vehicle is on the way of another one, or next to it in the same direction [m]


@dataclass(slots=True)
class _Ghost:
    lap: int
    route: str
    place: float  # Where it began [m]
    invented: bool  # Whether it speaks for itself; else its inventor says that it sees it


class Misconduct:
    """What the CAVs of one episode that misbehave do."""

    def __init__(self, settings: Misbehaviour, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        self._settings, self._road_map, self._model, self._seed = settings, road_map, model, seed
        self._kinds: dict[str, str] = {}
        self._ghosts: dict[str, _Ghost] = {}
        self._inventors: list[str] = []

    def kind_of(self, cav: str) -> str:
        """Return how a CAV misbehaves; empty for an honest one."""
        if cav not in self._kinds:
            self._kinds[cav] = self._drawn(cav)
        return self._kinds[cav]

    def _drawn(self, cav: str) -> str:
        """Draw once a CAV, whatever the others do; who misbehaves at one share of a kind does so at a higher one."""
        drawn = stream(self._seed, MISCONDUCT, cav).random()
        for kind, share in self._settings.shares.items():
            if drawn < share:
                return kind
            drawn -= share
        return ""

    def sent(self, cav: VehicleState, messages: tuple[V2xMessage, ...], world: WorldState) -> tuple[V2xMessage, ...]:
        """Return what a CAV sends in the place of its honest messages."""
        kind = self.kind_of(cav.id)
        if kind == "never_answers":
            return tuple(m for m in messages if not isinstance(m, ManoeuvreCoordination))
        if kind == "lies_position":
            return tuple(self._moved(m, world) if isinstance(m, CooperativeAwareness) else m for m in messages)
        if kind == "lies_intent":
            return tuple(self._other(m, cav) if isinstance(m, ManoeuvreCoordination) else m for m in messages)
        return messages

    def _moved(self, message: CooperativeAwareness, world: WorldState) -> CooperativeAwareness:
        """Shift a position along and across the route; to which sides is drawn once."""
        v, route = message.state, world.intents[message.sender].route
        ahead, right = (1 if drawn < 0.5 else -1 for drawn in stream(self._seed, MISCONDUCT, v.id, "sides").random(2))
        place, offset = self._road_map.project(route, v.x, v.y)
        place, offset = place + ahead * self._settings.along, offset + right * self._settings.across
        x, y, heading = self._road_map.paths[route].place(place)
        lane = self._road_map.lane_at(route, place)
        x, y = x - offset * sin(heading), y + offset * cos(heading)
        return replace(message, state=replace(v, x=x, y=y, heading=heading, lane=lane))

    def _other(self, message: ManoeuvreCoordination, cav: VehicleState) -> ManoeuvreCoordination:
        """Tell another route, of those that begin alike if there are any, and another target speed; drawn once."""
        own, speeds, routes = message.intent, self._model.target_speeds, self._road_map.routes
        first = routes[own.route].lanes[0]
        others = sorted(routes.keys() - {own.route})
        others = [name for name in others if routes[name].lanes[0] == first] or others or [own.route]
        which, further = stream(self._seed, MISCONDUCT, cav.id, "intent").random(2).tolist()
        route = others[int(which * len(others))]
        nearest = min(range(len(speeds)), key=lambda k: abs(speeds[k] - own.target_speed))
        target = speeds[(nearest + 1 + int(further * (len(speeds) - 1))) % len(speeds)]
        place, _ = self._road_map.project(route, cav.x, cav.y)
        return replace(message, intent=Intent(route, target, self._road_map.lane_at(route, place)))

    def ghosts(self, world: WorldState) -> Iterator[tuple[VehicleState, VehicleState, bool]]:
        """Return each ghost: who invents it, its state, and whether it speaks for itself."""
        for cav in world.cavs:
            if self.kind_of(cav.id) == "ghost" and (ghost := self._ghost_of(cav, world)) is not None:
                yield cav, *ghost

    def _ghost_of(self, cav: VehicleState, world: WorldState) -> tuple[VehicleState, bool] | None:
        """Return a vehicle that drives slowly ahead of another CAV, on its route, through whatever comes there."""
        lap = int(world.time / LAP + 1e-6)
        known = self._ghosts.get(cav.id)
        if known is None or known.lap != lap:
            others = [other for other in world.cavs if other.id != cav.id]
            if not others:
                return None
            whom, how = stream(self._seed, MISCONDUCT, cav.id, f"ghost {lap}").random(2).tolist()
            victim = others[int(whom * len(others))]
            route = world.intents[victim.id].route
            place = self._road_map.project(route, victim.x, victim.y)[0] + AHEAD
            known = self._ghosts[cav.id] = _Ghost(lap, route, place, how < 0.5)
        speed = PACE * self._model.top_speed
        place = known.place + speed * (world.time - lap * LAP)
        if place > self._road_map.routes[known.route].goal - ROOM:
            return None
        if cav.id not in self._inventors:
            self._inventors.append(cav.id)
        number = FIRST + 1000 * self._inventors.index(cav.id) + lap
        x, y, heading = self._road_map.paths[known.route].place(place)
        kind, lane = (Kind.CAV if known.invented else Kind.HDV), self._road_map.lane_at(known.route, place)
        return VehicleState(f"{kind}{number}", kind, x, y, heading, speed, 0.0, lane), known.invented

    def pushing(self, known: WorldState) -> WorldState:
        """Return what a CAV that does not yield minds of what it knows: no CAV but those on its way and next to it."""
        own = next(v for v in known.vehicles if v.id == known.viewer)
        route = known.intents[own.id].route
        kept = tuple(v for v in known.vehicles if v.kind is Kind.HDV or v.id == own.id or self._minds(route, own, v))
        names = {v.id for v in kept}
        intents = {name: intent for name, intent in known.intents.items() if name in names}
        available = {name: actions for name, actions in known.available.items() if name in names}
        return replace(known, vehicles=kept, intents=intents, available=available)

    def _minds(self, route: str, own: VehicleState, other: VehicleState) -> bool:
        place, offset = self._road_map.project(route, other.x, other.y)
        along = self._road_map.paths[route].place(place)[2]
        alike = abs(remainder(other.heading - along, tau)) < pi / 4
        return abs(offset) <= (BESIDE if alike else ON)


def with_ghost(messages: tuple[V2xMessage, ...], ghost: VehicleState, object_bytes: int) -> tuple[V2xMessage, ...]:
    """Add a ghost to what a CAV says that it sees."""
    return tuple(
        replace(m, objects=(*m.objects, PerceivedObject(ghost, "")), size=m.size + object_bytes)
        if isinstance(m, CollectivePerception)
        else m
        for m in messages
    )
