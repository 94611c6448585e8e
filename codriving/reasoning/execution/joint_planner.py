"""Plans all CAVs one after another in an order; what two plans mean for one another is worked out once."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from codriving.datatypes import Action, PassingOrder, TrackedVehicle
from codriving.geometry import TRUE, Array, Flags, Steps, first_true
from codriving.reasoning.conflicts import is_behind, is_open
from codriving.reasoning.execution.checked_humans import CheckedHumans
from codriving.reasoning.execution.violations import SIZES, Meeting, meetings_behind, minds_humans
from codriving.reasoning.exits import full_exit
from codriving.reasoning.ordering.protocol import JointPlan, JointPlanner
from codriving.reasoning.perception import Moment
from codriving.reasoning.prediction.expectation import Expected, planning_order, progress_by_action, worth
from codriving.reasoning.prediction.reversals import price
from codriving.reasoning.prediction.rollout import Plan, plan_library
from codriving.reasoning.safety.safety_input import SIDES, then_stop
from codriving.reasoning.safety.same_lane import LANE_END_GAP


@dataclass(frozen=True, slots=True)
class EarlyPassing:
    """A zone that a CAV passes before one that precedes it in the order: it is out of that one's way in time."""

    first: str  # Who passes the zone first, which comes later in the order
    second: str
    entries: tuple[float, float]  # Where the zone begins on the route of each [m]


@dataclass(frozen=True, slots=True)
class Joint:
    """What all CAVs do in one order."""

    chosen: Mapping[str, int]
    works: Mapping[str, Flags]
    stuck: tuple[str, ...]
    steps: Mapping[str, Steps]  # When each plan first comes too close; the number of samples where it never does
    gains: Mapping[str, Array]  # What each plan is worth in this order [m]


class JointPlans(JointPlanner):
    """The plans of one moment.

    Args:
        humans: How human drivers are minded; None for where they are likely to be (`minds_humans`).
        kept: Who means to pass which zone before one that precedes it, since a step ago.

    Attributes:
        plans: Every plan that a CAV may follow, before the one that it planned a step ago.
        travels: Distance of each plan over time, by id (plans, steps + 1) [m].
        gains: What each plan is worth, by id (plans,) [m].
    """

    def __init__(
        self,
        moment: Moment,
        before: Mapping[str, Plan],
        margin: float,
        pad: float,
        headway: float,
        humans: CheckedHumans | None = None,
        kept: Collection[EarlyPassing] = (),
    ) -> None:
        self.moment, self.pad, self.humans, self._kept = moment, pad, humans, kept
        self.vehicles = {name: known[name] for name, known in sorted(moment.vehicles.items())}
        sample = moment.forecast.sample
        self._lag, self._following = round(margin / sample), round(min(margin, headway) / sample)
        self._continued = {name: before[name] for name in self.vehicles if name in before}
        self._ahead = drives_ahead(moment, self.vehicles)
        own = self._continuations()
        full = ((name, full_exit(moment, moment.vehicles[name], v)) for name, v in self.vehicles.items())
        self._waits = {name: exit_[1] for name, exit_ in full if exit_ is not None}
        self.plans = plan_library(moment.forecast.model)
        self.travels: dict[str, Array] = {}
        self._alone: dict[str, Steps] = {}
        for v in self.vehicles.values():
            travels = moment.forecast.travel(v.speed, v.target, self.plans, v.routes[0])
            self.travels[v.id] = np.concatenate([travels, own[v.id]]) if v.id in own else travels
        self.gains = {name: worth(travels) for name, travels in self.travels.items()}
        if moment.forecast.model.steady:
            self.gains = {name: gained - self._price(name) for name, gained in self.gains.items()}
        self._met: dict[tuple[str, str], list[Meeting]] = {}
        self._open: dict[tuple[str, str], list[Meeting]] = {}
        self._pairs: dict[tuple[str, int, str], Steps] = {}
        self._joint: dict[tuple[object, ...], Joint] = {}
        self._towards: dict[tuple[object, ...], Steps] = {}

    def _continuations(self) -> dict[str, Array]:
        """Predict what each CAV planned a step ago (1, steps + 1)."""
        names = list(self._continued)
        if not names:
            return {}
        cavs = [self.vehicles[name] for name in names]
        states, plans = [(v.speed, v.target, *v.routes[0]) for v in cavs], [self._continued[name] for name in names]
        return dict(zip(names, self.moment.forecast.travel_each(states, plans)[:, None], strict=True))

    def _price(self, name: str) -> Array:
        """Return what the reversals of each plan of a CAV count as (plans,) [m]."""
        now = self.vehicles[name].speed, self.vehicles[name].target
        known = price(*now, self.plans)
        return np.append(known, price(*now, (self._continued[name],))) if name in self._continued else known

    def plan_of(self, name: str, k: int) -> Plan:
        """Return a plan of a CAV."""
        return self.plans[k] if k < len(self.plans) else self._continued[name]

    def joint(
        self, sequence: Sequence[str], not_before: Mapping[str, float] | None = None, times: Mapping[str, float] = {}
    ) -> Joint:
        """Plan all CAVs.

        Args:
            not_before: Earliest time at which some of them may reach their first zone, by id [s].
            times: When they are to pass, which tells who goes before which human driver; empty for a schedule [s].
        """
        # No vehicle waits for one that waits for room past the junction.
        goes = sorted(sequence, key=lambda name: name in self._waits)
        order = tuple(planning_order(goes, self.vehicles, self._ahead))
        held = tuple(sorted((not_before or {}).items()))
        agreed = self.humans.order(sequence, times) if self.humans is not None else None
        firsts = self.humans.firsts(agreed) if self.humans is not None and agreed is not None else ()
        if (order, held, firsts) not in self._joint:
            self._joint[order, held, firsts] = self._plan(order, dict(held), agreed)
        return self._joint[order, held, firsts]

    def rescued(
        self, sequence: Sequence[str], not_before: Mapping[str, float] | None = None, times: Mapping[str, float] = {}
    ) -> Joint:
        """Plan all CAVs as `joint` does; those for which no plan is left go first where that leaves fewer of them."""
        best = joint = self.joint(sequence, not_before, times)
        raised: list[str] = []
        while joint.stuck and len(raised) < len(joint.chosen):
            others = [name for name in best.chosen if name not in raised]
            raised += [name for name in joint.stuck if name in others] or others[:1]
            joint = self.joint([*raised, *(name for name in others if name not in raised)], not_before, times)
            best = min(best, joint, key=lambda found: len(found.stuck))
        return best

    def _plan(self, order: Sequence[str], held: Mapping[str, float], agreed: PassingOrder | None) -> Joint:
        chosen: dict[str, int] = {}
        works: dict[str, Flags] = {}
        until: dict[str, Steps] = {}
        gains: dict[str, Array] = {}
        stuck = []
        for name in order:
            steps = np.minimum(self._violations_alone(name), self._lets_pass(name, chosen))
            if name in held:
                steps = np.minimum(steps, self._too_early(name, held[name]))
            for other, k in chosen.items():
                against = self._against(other, k, name)
                if against is not None:
                    steps = np.minimum(steps, against)
            gains[name] = self.gains[name]
            if agreed is not None:
                steps, gains[name] = self._minds(name, agreed, steps)
            until[name], works[name] = steps, steps >= self.travels[name].shape[1]
            chosen[name] = self._choose(name, steps, gains[name])
            if not works[name].any():
                stuck.append(name)
        return Joint(chosen, works, tuple(stuck), until, gains)

    def _lets_pass(self, name: str, planned: Collection[str]) -> Steps:
        """When each plan of a CAV first comes too close to one that means to pass before it and is planned later."""
        found: Steps = np.full(len(self.travels[name]), self.travels[name].shape[1])
        for passage in self._kept:
            if passage.second == name and passage.first in self._continued and passage.first not in planned:
                for meeting in self.open_meetings(passage.first, name):
                    if meeting.is_at(passage.entries):
                        goes_on = self.travels[passage.first][-1]
                        found = np.minimum(found, meeting.steps(self.travels[name], goes_on))
        return found

    def _choose(self, name: str, steps: Steps, gains: Array) -> int:
        """Return the plan that is worth most of those that work."""
        travels = self.travels[name]
        works = steps >= travels.shape[1]
        if works.any():
            return int(np.argmax(np.where(works, gains, -np.inf)))
        # Of those that keep clear for longest the one that stops soonest.
        return int(np.argmin(np.where(steps == steps.max(), travels[:, -1], np.inf)))

    def _minds(self, name: str, agreed: PassingOrder, steps: Steps) -> tuple[Steps, Array]:
        """Return when each plan of a CAV first comes too close, and what it is worth, human drivers considered."""
        assert self.humans is not None
        travels, gains, n = self.travels[name], self.gains[name], len(self.plans)
        key = (name, *(pair for pair in self.humans.firsts(agreed) if name in pair))
        if key not in self._towards:
            self._towards[key] = self.humans.violations(name, agreed, travels)
        steps = np.minimum(steps, self._towards[key])
        gained = np.where(steps >= travels.shape[1], gains, -np.inf)
        less = self.humans.guesses(name, agreed, travels[:n], gained[:n])
        return steps, gains + [less.get(action, 0.0) for action in self._firsts(name)] if less else gains

    def _firsts(self, name: str) -> list[Action]:
        """Return the first action of each plan of a CAV."""
        return [self.plan_of(name, k)[0] for k in range(len(self.travels[name]))]

    def expected(self, joint: Joint) -> dict[str, tuple[Expected, ...]]:
        """Return how each CAV means to drive, and how far it would get after each action."""
        found, n = {}, len(self.plans)
        for name, k in joint.chosen.items():
            gains = progress_by_action(np.where(joint.works[name][:n], joint.gains[name][:n], -np.inf), self.plans)
            found[name] = tuple(
                Expected(route, place + self.travels[name][k], k == 0, gains if r == 0 else {})
                for r, (route, place) in enumerate(self.vehicles[name].routes)
            )
        return found

    def beginning(self, joint: Joint, actions: Mapping[str, Action]) -> Joint:
        """Let CAVs begin with given actions, and go on as well as that allows."""
        chosen, stuck = dict(joint.chosen), list(joint.stuck)
        for name, action in actions.items():
            so = np.array([first is action for first in self._firsts(name)])
            chosen[name] = self._choose(name, np.where(so, joint.steps[name], -1), joint.gains[name])
            if name not in stuck and not joint.works[name][chosen[name]]:
                stuck.append(name)
        return replace(joint, chosen=chosen, stuck=tuple(stuck))

    def _too_early(self, name: str, time: float) -> Steps:
        """When each plan reaches the first zone, if that is before the method allows it."""
        distance = min((c.distances[0] for c in self.moment.conflicts[name]), default=0.0)
        travels = self.travels[name]
        if distance <= 0:
            return np.full(len(travels), travels.shape[1])
        return first_true((travels >= distance) & (self.moment.forecast.times < time))

    def _violations_alone(self, name: str) -> Steps:
        """When each plan first comes too close to a human driver, or cannot stop before the lane ends any more."""
        if name not in self._alone:
            v, travels = self.vehicles[name], self.travels[name]
            steps: Steps = np.full(len(travels), travels.shape[1])
            if self.humans is None:
                steps = minds_humans(self.moment, v, travels, self._lag, self._following, self.pad)
            if name in self._waits:
                steps = np.minimum(steps, first_true(v.routes[0][1] + travels >= self._waits[name]))
            change = self.moment.scenes[name].must_change
            if change is not None:
                firsts = self._firsts(name)
                kinds = sorted(set(firsts))
                plans = [then_stop(a) for a in kinds]
                stops = self.moment.forecast.travel(v.speed, v.target, plans, v.routes[0])[:, -1]
                too_far = {a: stop > change.room - LANE_END_GAP for a, stop in zip(kinds, stops, strict=True)}
                steps = np.where([too_far[a] for a in firsts], 0, steps)
            self._alone[name] = steps
        return self._alone[name]

    def _against(self, first: str, k: int, second: str) -> Steps | None:
        """When each plan of a vehicle first comes too close to another one that has been planned before it."""
        meetings = self.meetings(first, second)
        if not meetings:
            return None
        key = (first, k, second)
        if key not in self._pairs:
            found: Steps = np.full(len(self.travels[second]), self.travels[second].shape[1])
            for meeting in meetings:
                steps = meeting.steps(self.travels[second], self.travels[first][k])
                if self.moment.by_zone and meeting in self.open_meetings(first, second):
                    steps = np.maximum(steps, meeting.steps_ahead(self.travels[second], self.travels[first][k]))
                found = np.minimum(found, steps)
            self._pairs[key] = found
        return self._pairs[key]

    def meetings(self, first: str, second: str) -> list[Meeting]:
        """Where one CAV has to mind another one that has been planned before it."""
        if (first, second) not in self._met:
            ego, other = self.vehicles[second], self.vehicles[first]
            found = meetings_behind(self.moment, ego, other, self._lag, self._following, self.pad)
            self._met[first, second] = found + self.open_meetings(first, second)
        return self._met[first, second]

    def open_meetings(self, first: str, second: str) -> list[Meeting]:
        """Where it is open which of two CAVs goes first."""
        if (first, second) not in self._open:
            ego, other, zones = self.vehicles[second], self.vehicles[first], self.moment.road_map.zones
            n, (route, place) = self.moment.forecast.steps + 1, ego.routes[0]
            found = self._open[first, second] = []
            for way, there in other.routes:
                for zone in zones(route, way):
                    if is_open(zone, place, there) and not is_behind(zone, place, there):
                        sizes = ((zone,), *(zones(route, way, size) for size in SIZES[1:]))
                        found.append(Meeting(sizes, place, there, n, self._lag, self.pad))
        return self._open[first, second]

    def passages(self, joint: Joint) -> list[EarlyPassing]:
        """Return every zone that a CAV passes before one that was planned before it."""
        found, names = list[EarlyPassing](), list(joint.chosen)
        for k, name in enumerate(names):
            mine = self.travels[name][joint.chosen[name]]
            for other in names[:k]:
                theirs = self.travels[other][joint.chosen[other]]
                found += [
                    EarlyPassing(name, other, meeting.entries)
                    for meeting in self.open_meetings(other, name)
                    if meeting.steps(mine[None], theirs)[0] < len(mine) <= meeting.steps_ahead(mine[None], theirs)[0]
                ]
        return found

    def plan(self, order: Sequence[str]) -> JointPlan:
        """Return what all CAVs would do."""
        joint = self.joint(order)
        travels = {name: self.travels[name][k] for name, k in joint.chosen.items()}
        worth = sum(float(joint.gains[name][k]) for name, k in joint.chosen.items())
        return JointPlan(not joint.stuck, travels, self.moment.forecast.sample, len(joint.stuck), worth)

    def gap_time(self, plan: JointPlan, one: str, other: str) -> float:
        """Return the least time between one vehicle's leaving a shared zone and the other's entering it."""
        least, time = float("inf"), self.moment.forecast.time_to
        mine, theirs = plan.travels[one], plan.travels[other]
        (route, place), (way, there) = self.vehicles[one].routes[0], self.vehicles[other].routes[0]
        for zone in self.moment.road_map.zones(route, way):
            if is_open(zone, place, there):
                gaps = (
                    time(zone.entry_j - there, theirs) - time(zone.exit_i - place, mine),
                    time(zone.entry_i - place, mine) - time(zone.exit_j - there, theirs),
                )
                least = min(least, max([gap for gap in gaps if np.isfinite(gap)], default=float("inf")))
        return least


def drives_ahead(moment: Moment, vehicles: Mapping[str, TrackedVehicle]) -> set[tuple[str, str]]:
    """Return the pairs of CAVs (ahead, behind) that follow one another, whatever the order says."""
    return {
        (ahead.id, behind.id)
        for behind in vehicles.values()
        for ahead in vehicles.values()
        if ahead.id != behind.id
        and (meetings_behind(moment, behind, ahead, 0, 0, 0.0) or _is_alongside(moment, behind, ahead))
    }


def _is_alongside(moment: Moment, changing: TrackedVehicle, other: TrackedVehicle) -> bool:
    """Whether a CAV cannot go first since another one drives ahead or alongside on the lane that it must change to."""
    change = moment.scenes[changing.id].must_change
    if change is None or SIDES.keys().isdisjoint(moment.available[changing.id]):
        return False
    (route, place), (way, there) = changing.routes[0], other.routes[0]
    if moment.scenes[other.id].ego.lane != change.lane:
        return False
    for zone in moment.road_map.zones(route, way):
        if zone.merge_i is not None and zone.merge_j is not None and is_open(zone, place, there):
            return zone.merge_j - there < zone.merge_i - place + TRUE.length
    return False
