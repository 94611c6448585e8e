"""Which lane to be on: where the route asks for a change, and where MOBIL says that it pays."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from codriving.datatypes import Action, LaneId, Role, TrackedVehicle
from codriving.errors import require_range
from codriving.reasoning import SIDES, IntelligentDriver, Moment, with_roles

SLOWEST = 3.0  # Below this speed lanes are not changed just to get farther, since both would be blocked [m/s]


@dataclass(frozen=True, slots=True)
class Change:
    """A lane change that is safe and wanted."""

    action: Action
    reason: str
    gain: float  # What it is worth [m/s2]


@dataclass(frozen=True, slots=True)
class Side:
    """The lane beside, as seen from there."""

    lane: LaneId
    ahead: TrackedVehicle | None
    behind: TrackedVehicle | None
    far: str


# Largest value of each setting.
LIMITS = {"politeness": 1, "threshold": 5, "safe_braking": 10, "least_gap": 50, "alongside": 50, "cool_down": 60}

# Says why a change in front of the new follower is refused; nothing if it is not.
LetsIn = Callable[[Moment, str, Side, IntelligentDriver], str]


@dataclass(eq=False, repr=False)
class LaneChoice:
    """Changes lanes by MOBIL (Kesting, Treiber and Helbing, 2007), and where the route asks for it."""

    politeness: float
    threshold: float
    safe_braking: float
    least_gap: float
    alongside: float
    cool_down: float

    def __post_init__(self) -> None:
        for key, most in LIMITS.items():
            require_range(key, getattr(self, key), 0, most)
        self._changed: dict[str, float] = {}

    def reset(self) -> None:
        """Begin an episode; no CAV has changed lanes yet."""
        self._changed.clear()

    def choose(
        self, moment: Moment, ego: str, idm: IntelligentDriver, lets_in: LetsIn | None = None
    ) -> tuple[Change | None, dict[Action, str]]:
        """Return the lane change that is worth most, and why others are left out."""
        refused: dict[Action, str] = {}
        options = []
        for action in (a for a in SIDES if a in moment.available[ego]):
            said = self._idle(moment, ego, action)
            side = None if said else look(moment, ego, action, self.alongside)
            if side is None:
                refused[action] = said or "the lane does not lead where the vehicle goes"
                continue
            must = moment.scenes[ego].must_change is not None
            gain = self.gain(moment, ego, side, idm)
            if not must and gain <= self.threshold:
                refused[action] = f"MOBIL: it gains {gain:.1f} m/s2, less than {self.threshold:g}"
                continue
            unsafe = self.unsafe(moment, ego, side, idm, must) or (lets_in or self.braked_for)(moment, ego, side, idm)
            if unsafe:
                refused[action] = unsafe
                continue
            paid = f"MOBIL: the lane change gains {gain:.1f} m/s2"
            why = "the route asks for the lane change, and the gap is large enough" if must else paid
            options.append(Change(action, why, gain))
        if not options:
            return None, refused
        best = max(options, key=lambda change: (change.gain, change.action is Action.LANE_LEFT))
        refused.update({o.action: "the other side is better" for o in options if o is not best})
        self._changed[ego] = moment.time
        return best, refused

    def _idle(self, moment: Moment, ego: str, action: Action) -> str:
        """Why a lane change is not looked at."""
        scene = moment.scenes[ego]
        if scene.must_change is not None:
            return "" if action is scene.must_change.action else "the route asks for the other side"
        if scene.covers:
            return "a lane change is under way"
        if scene.ego.speed < SLOWEST:
            return "too slow to change lanes just to get farther"
        since = moment.time - self._changed.get(scene.ego.id, -self.cool_down)
        return "lanes have just been changed" if since < self.cool_down else ""

    def unsafe(self, moment: Moment, ego: str, side: Side, idm: IntelligentDriver, must: bool) -> str:
        """Say why a lane change is not safe, whatever the new follower does; nothing if it is."""
        if side.far and not must:
            return f"{side.far} is alongside on the other side and might change there, too"
        ahead, behind = side.ahead, side.behind
        if ahead is not None and ahead.gap is not None:
            speed, top = moment.scenes[ego].ego.speed, moment.forecast.model.top_speed
            braking = -idm.accelerate(speed, top, ahead.gap, ahead.speed)
            if ahead.gap < self.least_gap or braking > self.safe_braking:
                return f"{ahead.id} is {max(ahead.gap, 0.0):.0f} m ahead there"
        if behind is not None and behind.gap is not None and behind.gap < self.least_gap:
            return f"{behind.id} is {max(behind.gap, 0.0):.0f} m behind there"
        return ""

    def braked_for(self, moment: Moment, ego: str, side: Side, idm: IntelligentDriver) -> str:
        """Say that the new follower would have to brake too hard, if it would."""
        behind = side.behind
        if behind is None or behind.gap is None:
            return ""
        top, speed = moment.forecast.model.top_speed, moment.scenes[ego].ego.speed
        braking = -idm.accelerate(behind.speed, top, behind.gap, speed)
        return f"{behind.id} behind would have to brake at {braking:.1f} m/s2" if braking > self.safe_braking else ""

    def gain(self, moment: Moment, ego: str, side: Side, idm: IntelligentDriver) -> float:
        """Return MOBIL's incentive: what the vehicle gains, and politely what those behind it do [m/s2]."""
        scene = moment.scenes[ego]
        here, there = (scene.next_in(Role.LEADING), scene.next_in(Role.REARING)), (side.ahead, side.behind)
        return idm.incentive(scene.ego, moment.forecast.model.top_speed, here, there, self.politeness)


def look(moment: Moment, ego: str, action: Action, alongside: float) -> Side | None:
    """Return the lane beside; None if no route along it leads where the vehicle goes."""
    scene, changes = moment.scenes[ego], moment.road_map.changes
    start, end, index = scene.intent.target_lane
    lane = (start, end, index + SIDES[action])
    routes = {side: name for name, side in changes.routes_beside(scene.intent.route, scene.intent.target_lane)}
    if lane not in routes:
        return None
    route = routes[lane]
    place, _ = moment.road_map.project(route, scene.ego.x, scene.ego.y)
    there = replace(scene, neighbours=with_roles(scene.neighbours, scene.ego, route, place, moment.road_map))
    beyond = (start, end, index + 2 * SIDES[action])
    far = next((name for name, side in changes.routes_beside(route, lane) if side == beyond), None)
    alongside_far = (
        n.id for n in scene.neighbours if any(way == far and abs(at - place) < alongside for way, at in n.routes)
    )
    near = next(alongside_far, "")
    return Side(lane, there.next_in(Role.LEADING), there.next_in(Role.REARING), near)
