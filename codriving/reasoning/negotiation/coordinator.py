"""The conflict coordinator by rules: arrival order, turning yields to straight, who is committed goes (III-C.3)."""

from collections.abc import Mapping
from typing import Protocol

from codriving.datatypes.conflict import Conflict, Relation
from codriving.datatypes.order import PassingOrder, Precedence
from codriving.datatypes.road import Turn
from codriving.datatypes.scene_description import Role, SceneDescription
from codriving.geometry.box import TRUE
from codriving.geometry.road_map import RoadMap
from codriving.prediction.forecast import Forecast
from codriving.reasoning.negotiation.acyclic import without_cycles
from codriving.reasoning.negotiation.human_windows import is_blocked, window
from codriving.reasoning.negotiation.improve import improve
from codriving.reasoning.negotiation.reasons import reason_between, reason_human
from codriving.reasoning.negotiation.schedule import GAP, Slot, lag_length, start_time

TURN_YIELDS = 1.0
"""A turning vehicle goes before one that goes straight only if it can do so this much earlier [s]."""

KEEPS_TURN = 1.0
"""An order that has been agreed on is changed only if the other one can go this much earlier [s]."""

FOREVER = 1e3
"""Beyond every time that matters [s]."""

Scenes = Mapping[str, SceneDescription]
Conflicts = Mapping[str, tuple[Conflict, ...]]


class Coordinator(Protocol):
    """Decides who goes first: one call for all vehicles."""

    def negotiate(self, scenes: Scenes, conflicts: Conflicts) -> PassingOrder:
        """Return an order without cycles for all conflicts.

        Args:
            scenes: What each CAV knows, by id.
            conflicts: Conflicts of each CAV, by id.
        """
        ...


class RuleCoordinator:
    """Schedules whoever can pass first, again and again, with the traffic rules as handicaps.

    Args:
        road_map: The precomputed road.
        forecast: Predictions of the present step.
        binding: Whether the order is an instruction (CDA class D).
    """

    def __init__(self, road_map: RoadMap, forecast: Forecast, binding: bool) -> None:
        self.road_map, self.forecast, self.binding = road_map, forecast, binding
        self.previous: PassingOrder | None = None

    def negotiate(self, scenes: Scenes, conflicts: Conflicts) -> PassingOrder:
        """Return an order without cycles for all conflicts.

        Args:
            scenes: What each CAV knows, by id.
            conflicts: Conflicts of each CAV, by id.
        """
        slots = {ego: self._slot(scenes[ego], conflicts[ego]) for ego in sorted(scenes) if conflicts[ego]}
        separation = self._separations(slots, conflicts)
        self._add_leaders(slots, separation, scenes)
        passages = {ego: self._add_windows(slots[ego], scenes[ego], conflicts[ego]) for ego in slots}
        fixed = self._fixed(slots, scenes, conflicts)
        times = self._list_schedule(slots, separation, fixed)
        times = improve(times, slots, separation, fixed, self.previous)
        precedences = []
        for ego, other in sorted({tuple(sorted((c.ego, c.other))) for cs in conflicts.values() for c in cs}):
            if ego in slots and other in slots:
                first, second = sorted((ego, other), key=lambda name: list(times).index(name))
                precedences.append(Precedence(first, second, reason_between(slots[first], slots[second])))
        arrivals = dict(times)
        for ego, people in passages.items():
            for human, (begin, end) in people.items():
                human_first = times[ego] > begin
                first, second = (human, ego) if human_first else (ego, human)
                precedences.append(Precedence(first, second, reason_human(human_first, begin, end, times[ego])))
                arrivals[human] = min(arrivals.get(human, begin), begin)
        kept, sequence = without_cycles(precedences, arrivals)
        self.previous = PassingOrder(sequence, kept, self.binding)
        return self.previous

    def _slot(self, scene: SceneDescription, conflicts: tuple[Conflict, ...]) -> Slot:
        route, speed = self.road_map.routes[scene.intent.route], scene.ego.speed
        reference = min(self.road_map.zones(*c.routes)[c.zone].entry_i for c in conflicts)
        ahead = reference - scene.place
        go = self.forecast.reach(speed, True)
        top = self.forecast.model.target_speeds[-1]
        eta = self.forecast.time_to(ahead, go.most) if ahead > 0 else ahead / top
        # Turning matters where ways cross; on a ring or a ramp nobody goes straight on.
        turning = route.turn is not Turn.STRAIGHT and any(c.relation is Relation.CROSSING for c in conflicts)
        return Slot(scene.ego.id, reference, eta, bool(go.least[-1] >= ahead), turning)

    def _separations(self, slots: dict[str, Slot], conflicts: Conflicts) -> dict[tuple[str, str], float]:
        top = self.forecast.model.target_speeds[-1]
        found: dict[tuple[str, str], float] = {}
        for ego in slots:
            for c in conflicts[ego]:
                if c.other not in slots:
                    continue
                zone = self.road_map.zones(*c.routes)[c.zone]
                for pair, seen in (((ego, c.other), zone), ((c.other, ego), zone.mirrored())):
                    shift = slots[pair[1]].reference - slots[pair[0]].reference
                    needed = (lag_length(seen) + shift) / top + GAP
                    found[pair] = max(needed, found.get(pair, needed))
        return found

    def _add_leaders(self, slots: dict[str, Slot], separation: dict[tuple[str, str], float], scenes: Scenes) -> None:
        top = self.forecast.model.target_speeds[-1]
        for ego, slot in slots.items():
            for n in scenes[ego].neighbours:
                if n.role is Role.LEADING and n.id in slots:
                    slot.leader = n.id
                    separation[n.id, ego] = max(separation.get((n.id, ego), 0.0), 7.0 / top + 0.5)

    def _fixed(self, slots: dict[str, Slot], scenes: Scenes, conflicts: Conflicts) -> set[tuple[str, str]]:
        """Return the pairs whose order is physical: a leader, or one who cannot stop before the zone any more."""
        found = {(slot.leader, ego) for ego, slot in slots.items() if slot.leader is not None}
        for ego in slots:
            for c in conflicts[ego]:
                if c.other not in slots:
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
        return any(z.entry_i <= least and c.places[0] < z.exit_i for z in self.road_map.zones(*c.routes, TRUE))

    def _other_cannot_stop(self, scenes: Scenes, c: Conflict) -> bool:
        least = c.places[1] + self.forecast.reach(scenes[c.other].ego.speed, True).least[-1]
        return any(z.entry_j <= least and c.places[1] < z.exit_j for z in self.road_map.zones(*c.routes, TRUE))

    def _add_windows(
        self, slot: Slot, scene: SceneDescription, conflicts: tuple[Conflict, ...]
    ) -> dict[str, tuple[float, float]]:
        """Block the times at which human drivers may pass; return the blocked interval of each of them."""
        found: dict[str, tuple[float, float]] = {}
        for c in conflicts:
            n = scene.neighbour(c.other)
            if n is None or n.intent is not None:
                continue
            begin, end = window(c, n, slot.reference, self.road_map, self.forecast)
            if n.standing > 0 and is_blocked(c, self.road_map):
                begin, end = -FOREVER, FOREVER
            slot.windows.append((begin, end))
            known = found.get(c.other, (begin, end))
            found[c.other] = (min(begin, known[0]), max(end, known[1]))
        return found

    def _list_schedule(
        self, slots: dict[str, Slot], separation: dict[tuple[str, str], float], fixed: set[tuple[str, str]]
    ) -> dict[str, float]:
        """Schedule the vehicle with the smallest start time, handicaps included, until all are scheduled."""
        times: dict[str, float] = {}
        waiting = dict(slots)
        while waiting:
            held = {second for first, second in fixed if first in waiting}
            ready = [s for s in waiting.values() if s.id not in held] or list(waiting.values())
            options = []
            for slot in ready:
                time = start_time(slot, times, separation)
                handicap = TURN_YIELDS if slot.turning else 0.0
                if any(self._was_first(k, slot.id) for k in waiting if (k, slot.id) in separation and k != slot.id):
                    handicap += KEEPS_TURN
                options.append((not slot.committed, time + handicap, slot.id, time))
            _, _, name, time = min(options)
            times[name] = time
            del waiting[name]
        return times

    def _was_first(self, one: str, other: str) -> bool:
        return self.previous is not None and self.previous.first_of(one, other) == one
