"""Which CAVs request a lane change: where the route needs it, and where MOBIL's incentive says that it pays."""

from collections.abc import Mapping

from codriving.datatypes.action import Action
from codriving.datatypes.order import PassingOrder
from codriving.datatypes.scene_description import Role, SceneDescription
from codriving.reasoning.moment import Moment
from codriving.reasoning.ordering.protocol import Ordering
from codriving.reasoning.ordering.request import Request
from codriving.reasoning.prediction.expectation import Expected
from codriving.reasoning.prediction.idm import IntelligentDriver
from codriving.reasoning.safety.adjacent_lane import HEADWAY, MARGIN, check_adjacent
from codriving.reasoning.safety.safety_input import SIDES, safety_input

POLITENESS = 0.3
"""Weight of what those behind gain or lose (MOBIL)."""

THRESHOLD = 0.2
"""Incentive below which no CAV wants to change lanes [m/s2]."""

COOL_DOWN = 2.0
"""Time between two lane changes of one CAV [s]."""

SLOWEST = 3.0
"""Below this speed lanes are not changed just to get farther, since both would be blocked [m/s]."""

BODY = 5.0
"""Length of a vehicle [m]."""

DRIVER = IntelligentDriver()


class LaneRequests:
    """Requests of CAVs that want to change lanes and may by the gap test of all methods; remembers their first time."""

    def __init__(self) -> None:
        self._since: dict[tuple[str, Action], float] = {}
        self._changed: dict[str, float] = {}

    def gather(
        self,
        moment: Moment,
        ordering: Ordering,
        agreed: PassingOrder,
        expected: Mapping[str, tuple[Expected, ...]],
        lag: int,
    ) -> list[Request]:
        """Return the requests of this moment, the earliest first."""
        found = {name: self._wanted(moment, name, agreed, expected, lag) for name in sorted(moment.scenes)}
        wanted = {name: change for name, change in found.items() if change is not None}
        self._since = {
            (name, action): self._since.get((name, action), moment.time) for name, (action, _) in wanted.items()
        }
        requests = [
            Request(name, action, incentive, self._since[name, action], _overlaps(moment.scenes, name, wanted))
            for name, (action, incentive) in wanted.items()
        ]
        return sorted(requests, key=lambda r: (r.since, r.ego))

    def granted(self, names: frozenset[str], time: float) -> None:
        """Note the CAVs that change lanes at a simulated time [s]."""
        self._changed |= dict.fromkeys(sorted(names), time)

    def _wanted(
        self,
        moment: Moment,
        name: str,
        agreed: PassingOrder,
        expected: Mapping[str, tuple[Expected, ...]],
        lag: int,
    ) -> tuple[Action, float] | None:
        """Return the lane change that a CAV wants most among those that pass the gap test, and its incentive."""
        scene, actions = moment.scenes[name], moment.available[name]
        sides = [action for action in SIDES if action in actions]
        must = scene.must_change
        if not sides or (must is None and not self._may_choose(scene, moment.time)):
            return None
        if must is not None:
            sides = [a for a in sides if scene.ego.lane[2] + SIDES[a] == must.lane[2]]
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
    found = set()
    mine = scenes[name]
    lanes = _lanes(mine, wanted[name][0])
    for other in wanted:
        theirs = scenes[other]
        if other == name or theirs.ego.lane[:2] != mine.ego.lane[:2]:
            continue
        room = BODY + MARGIN + HEADWAY * max(mine.ego.speed, theirs.ego.speed)
        away = ((mine.ego.x - theirs.ego.x) ** 2 + (mine.ego.y - theirs.ego.y) ** 2) ** 0.5
        if away < room and lanes & _lanes(theirs, wanted[other][0]):
            found.add(other)
    return frozenset(found)


def _lanes(scene: SceneDescription, action: Action) -> frozenset[int]:
    index = scene.ego.lane[2]
    return frozenset((index, index + SIDES[action]))
