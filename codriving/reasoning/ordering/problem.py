"""From scenes and conflicts to the ordering problem of the moment, which every method that orders is handed."""

from collections.abc import Mapping
from dataclasses import dataclass

from codriving.datatypes.conflict import Conflict, Relation
from codriving.datatypes.ordering_problem import Entrant, Instance, Pair
from codriving.datatypes.road import Turn
from codriving.datatypes.scene_description import Role, SceneDescription
from codriving.geometry.box import TRUE, Footprint
from codriving.geometry.road_map import RoadMap
from codriving.reasoning.ordering.human_windows import is_blocked, window
from codriving.reasoning.ordering.separation import FOLLOWS, GAP, lag_length
from codriving.reasoning.prediction.forecast import Forecast

COMMITTED = Footprint(5.6, 2.8)
"""Size of a vehicle that has stopped in time [m]: the body, and the room that others need to cut a corner beside it."""

FOREVER = 1e3
"""Beyond every time that matters [s]."""

Scenes = Mapping[str, SceneDescription]
Conflicts = Mapping[str, tuple[Conflict, ...]]
Passages = Mapping[str, Mapping[str, tuple[float, float]]]
"""When each human driver may be in the way of each CAV, by CAV and driver [s]."""


@dataclass(frozen=True, slots=True)
class Problem:
    """An ordering problem and what is known of the human drivers in it."""

    instance: Instance
    passages: Passages


class ProblemMaker:
    """Poses the ordering problem of each moment.

    Args:
        gap: Time between one vehicle's leaving a zone and the next one's entering it [s].
    """

    def __init__(self, road_map: RoadMap, forecast: Forecast, gap: float = GAP) -> None:
        self.road_map, self.forecast, self.gap = road_map, forecast, gap

    def pose(self, scenes: Scenes, conflicts: Conflicts, time: float) -> Problem:
        """Return the problem of one moment: every CAV that still has a conflict ahead is to be ordered.

        Args:
            time: Simulated time [s].
        """
        entrants = {ego: self._entrant(scenes[ego], conflicts[ego]) for ego in sorted(scenes) if conflicts[ego]}
        separation = self._separations(entrants, conflicts)
        self._add_leaders(entrants, separation, scenes)
        passages = {ego: self._add_windows(entrants[ego], scenes[ego], conflicts[ego]) for ego in entrants}
        before = frozenset(self._fixed(entrants, scenes, conflicts))
        return Problem(Instance(time, entrants, separation, before), passages)

    @property
    def _top(self) -> float:
        return self.forecast.model.target_speeds[-1]

    def _entrant(self, scene: SceneDescription, conflicts: tuple[Conflict, ...]) -> Entrant:
        route, speed = self.road_map.routes[scene.intent.route], scene.ego.speed
        zones = [self.road_map.zones(*c.routes)[c.zone] for c in conflicts]
        reference = min(zone.entry_i for zone in zones)
        ahead = reference - scene.place
        go = self.forecast.reach(speed, True)
        lane = self.road_map.lane_at(route.id, scene.place)
        # Turning matters where ways cross; on a ring or a ramp nobody goes straight on.
        turning = route.turn is not Turn.STRAIGHT and any(c.relation is Relation.CROSSING for c in conflicts)
        return Entrant(
            id=scene.ego.id,
            reference=reference,
            eta=self.forecast.time_to(ahead, go.most) if ahead > 0 else ahead / self._top,
            committed=bool(go.least[-1] >= ahead),
            turning=turning,
            lane="/".join(map(str, lane)),
            stream="/".join((*map(str, lane), str(route.turn))),
            distance=max(ahead, 0.0),
            crossing=(max(zone.exit_i for zone in zones) - reference) / self._top,
            remaining=max(route.goal - scene.place, 0.0),
            speed=speed,
            priority=self.road_map.lanes[lane].priority,
        )

    def _separations(self, entrants: Mapping[str, Entrant], conflicts: Conflicts) -> dict[Pair, float]:
        found: dict[Pair, float] = {}
        for ego in entrants:
            for c in conflicts[ego]:
                if c.other not in entrants:
                    continue
                zone = self.road_map.zones(*c.routes)[c.zone]
                for pair, first in (((ego, c.other), True), ((c.other, ego), False)):
                    shift = entrants[pair[1]].reference - entrants[pair[0]].reference
                    needed = (lag_length(zone, first) + shift) / self._top + self.gap
                    found[pair] = max(needed, found.get(pair, needed))
        return found

    def _add_leaders(self, entrants: dict[str, Entrant], separation: dict[Pair, float], scenes: Scenes) -> None:
        distance, time = FOLLOWS
        for ego, entrant in entrants.items():
            for n in scenes[ego].neighbours:
                if n.role is Role.LEADING and n.id in entrants:
                    entrant.leader = n.id
                    separation[n.id, ego] = max(separation.get((n.id, ego), 0.0), distance / self._top + time)

    def _fixed(self, entrants: Mapping[str, Entrant], scenes: Scenes, conflicts: Conflicts) -> set[Pair]:
        """Return the pairs whose order is physical: a leader, or one who cannot stop before the zone any more."""
        found = {(entrant.leader, ego) for ego, entrant in entrants.items() if entrant.leader is not None}
        for ego in entrants:
            for c in conflicts[ego]:
                if c.other not in entrants:
                    continue
                mine, theirs = self._cannot_stop(scenes[ego], c), self._other_cannot_stop(scenes, c)
                if mine and (not theirs or self._is_ahead(c)):
                    found.add((ego, c.other))
        return found

    def _is_ahead(self, c: Conflict) -> bool:
        """Whether the CAV is already past the place at which the other one would be in its way."""
        zones = self.road_map.zones(*c.routes, TRUE)
        return any(z.entry_j < c.places[1] and c.places[0] > float(z.front(c.places[1])) > 0 for z in zones)

    def _cannot_stop(self, scene: SceneDescription, c: Conflict) -> bool:
        least = c.places[0] + self.forecast.reach(scene.ego.speed, True).least[-1]
        return any(z.entry_i <= least and c.places[0] < z.exit_i for z in self.road_map.zones(*c.routes, COMMITTED))

    def _other_cannot_stop(self, scenes: Scenes, c: Conflict) -> bool:
        least = c.places[1] + self.forecast.reach(scenes[c.other].ego.speed, True).least[-1]
        return any(z.entry_j <= least and c.places[1] < z.exit_j for z in self.road_map.zones(*c.routes, COMMITTED))

    def _add_windows(
        self, entrant: Entrant, scene: SceneDescription, conflicts: tuple[Conflict, ...]
    ) -> dict[str, tuple[float, float]]:
        """Block the times at which human drivers may pass; return the blocked interval of each of them."""
        found: dict[str, tuple[float, float]] = {}
        for c in conflicts:
            n = scene.neighbour(c.other)
            if n is None or n.intent is not None:
                continue
            begin, end = window(c, n, entrant.reference, self.road_map, self.forecast)
            if n.standing > 0 and is_blocked(c, self.road_map):
                begin, end = -FOREVER, FOREVER
            entrant.windows.append((begin, end))
            known = found.get(c.other, (begin, end))
            found[c.other] = (min(begin, known[0]), max(end, known[1]))
        return found
