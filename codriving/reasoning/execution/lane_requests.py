"""Which CAVs request a lane change: where the route needs it, and where MOBIL's incentive says that it pays."""

from collections.abc import Mapping

from codriving.datatypes import Action, PassingOrder, Role, SceneDescription, VehicleState
from codriving.geometry import TRUE
from codriving.reasoning.ordering.protocol import Request
from codriving.reasoning.perception import Moment
from codriving.reasoning.prediction.expectation import Expected
from codriving.reasoning.prediction.idm import IntelligentDriver
from codriving.reasoning.safety.adjacent_lane import HEADWAY, MARGIN, check_adjacent
from codriving.reasoning.safety.safety_input import SIDES, safety_input

POLITENESS = 0.3  # Weight of what those behind gain or lose (MOBIL)

THRESHOLD = 0.2  # Incentive below which no CAV wants to change lanes [m/s2]

COOL_DOWN = 2.0  # Time between two lane changes of one CAV [s]

SLOWEST = 3.0  # Below this speed lanes are not changed just to get farther, since both would be blocked [m/s]

DRIVER = IntelligentDriver()


class LaneRequests:
    """Requests of CAVs that want to change lanes and may by the gap test of all methods; remembers their first time."""

    def __init__(self) -> None:
        self._since: dict[tuple[str, Action], float] = {}
        self._changed: dict[str, float] = {}

    def gather(
        self, moment: Moment, agreed: PassingOrder, expected: Mapping[str, tuple[Expected, ...]], lag: int
    ) -> list[Request]:
        """Return the requests of this moment, the earliest first."""
        found = {name: self._wanted(moment, name, agreed, expected, lag) for name in sorted(moment.scenes)}
        wanted = {name: change for name, change in found.items() if change is not None}
        asked = [(name, action) for name, (action, _) in wanted.items()]
        self._since = {key: self._since.get(key, moment.time) for key in asked}
        requests = [
            Request(name, action, incentive, self._since[name, action], _overlaps(moment.scenes, name, wanted))
            for name, (action, incentive) in wanted.items()
        ]
        return sorted(requests, key=lambda r: (r.since, r.ego))

    def granted(self, names: frozenset[str], time: float) -> None:
        """Note the CAVs that change lanes at a simulated time [s]."""
        self._changed |= dict.fromkeys(sorted(names), time)

    def _wanted(
        self, moment: Moment, name: str, agreed: PassingOrder, expected: Mapping[str, tuple[Expected, ...]], lag: int
    ) -> tuple[Action, float] | None:
        """Return the lane change that a CAV wants most among those that pass the gap test, and its incentive."""
        scene, actions = moment.scenes[name], moment.available[name]
        sides = [action for action in SIDES if action in actions]
        must = scene.must_change
        if not sides or (must is None and not self._may_choose(scene, moment.time)):
            return None
        if must is not None:
            sides = [a for a in sides if a is must.action]
        given = safety_input(moment, name, agreed, expected, lag)
        unsafe = check_adjacent(given)
        options = []
        for action in sides:
            there = given.beside(action)
            if action in unsafe or there is None:
                continue
            gain = float("inf") if must is not None else incentive(scene, there.scene, moment)
            if gain > THRESHOLD:
                options.append((gain, -SIDES[action], action))
        if not options:
            return None
        gain, _, action = max(options)
        return action, gain

    def _may_choose(self, scene: SceneDescription, time: float) -> bool:
        rested = time - self._changed.get(scene.ego.id, -COOL_DOWN) >= COOL_DOWN
        return rested and not scene.covers and scene.ego.speed >= SLOWEST


def incentive(scene: SceneDescription, there: SceneDescription, moment: Moment) -> float:
    """Return MOBIL's incentive of a lane change, for the CAV and those behind it on both lanes [m/s2]."""
    now, then = ((s.next_in(Role.LEADING), s.next_in(Role.REARING)) for s in (scene, there))
    return DRIVER.incentive(scene.ego, moment.forecast.model.top_speed, now, then, POLITENESS)


def _overlaps(
    scenes: Mapping[str, SceneDescription], name: str, wanted: Mapping[str, tuple[Action, float]]
) -> frozenset[str]:
    """Return the CAVs whose lane change needs the same piece of road at the same time."""
    mine = scenes[name].ego

    def lanes(cav: str) -> set[int]:
        index = scenes[cav].ego.lane[2]
        return {index, index + SIDES[wanted[cav][0]]}

    def near(other: VehicleState) -> bool:
        room = TRUE.length + MARGIN + HEADWAY * max(mine.speed, other.speed)
        return bool(((mine.x - other.x) ** 2 + (mine.y - other.y) ** 2) ** 0.5 < room)

    others = [other for other in wanted if other != name and scenes[other].ego.lane[:2] == mine.lane[:2]]
    return frozenset(other for other in others if near(scenes[other].ego) and lanes(name) & lanes(other))
