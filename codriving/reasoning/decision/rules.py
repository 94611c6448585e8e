"""The built-in rule reasoner behind ``llm=offline``: it sees what a model would be told, and nothing else."""

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence

from codriving.datatypes import Action, Decision, Role, SceneDescription, Situation, TrackedVehicle
from codriving.reasoning.decision.cases import reconsider
from codriving.reasoning.prediction.reversals import reverses
from codriving.reasoning.safety.safety_input import SIDES

# Actions along the lane from the most to the least progress; where IDLE and HOLD are as fast, IDLE is taken.
EAGERNESS = (Action.FASTER, Action.IDLE, Action.HOLD, Action.SLOWER)

OVERTAKES = 0.05  # Share of the progress that a lane change must gain to be worth it

STANDS = 0.5  # Below this speed a CAV stands [m/s]

SLOWEST_CHANGE = 3.0  # Lanes are not changed just to get farther below this speed [m/s]

YIELDS = 15.0  # Progress that is given up for a lane change that the route asks for [m]

TOLERANCE = 0.02  # Share of the progress that is given up to be closer when the way becomes free earlier than expected

HORIZON = 10.0  # How far ahead the progress of an action is predicted [s]

HEADWAY = 2.0  # The vehicle ahead is not to be considered if the CAV stays this far behind at least [s]


class Decider(ABC):
    """Decides for all vehicles in one call; rules and language models alike."""

    def reset(self, seed: int) -> None:
        """Begin an episode: the seed is for what is drawn at random."""
        return None

    @abstractmethod
    def decide(self, situations: Sequence[Situation]) -> list[Decision]:
        """Return one decision a situation, in the same order."""


class RuleDecider(Decider):
    """Goes as fast as is safe and as the passing order allows, and repeats no mistake that is remembered."""

    def decide(self, situations: Sequence[Situation]) -> list[Decision]:
        """Return one decision a situation, in the same order."""
        return [reconsider(situation, decide_one(situation)) for situation in situations]


def decide_one(situation: Situation) -> Decision:
    """Take the allowed action that gets the CAV farthest if it lets those pass who go first; if equal, the fastest.

    Lanes are changed where the route asks for it as soon as that is allowed, and elsewhere to get clearly farther.
    """
    scene, ego, left_over = situation.scene, situation.scene.ego.id, situation.allowed
    allowed = [action for action in EAGERNESS if action in left_over]
    allowed.sort(key=lambda action: scene.speed_rank(action) or 0.0, reverse=True)
    if any(a.safe and a.reasons for a in situation.assessments):
        least = left_over[0]
        return Decision(ego, least, f"no action is safe, and {least} is the least dangerous")
    left = [a for a in situation.assessments if a.action in left_over]
    reached = {a.action: a.progress for a in left if a.progress is not None}
    change = _lane_change(situation, reached)
    if change is not None:
        return change
    if not allowed:
        return Decision(ego, left_over[0], "the only action that the safety check left")
    waits_for = ", ".join(dict.fromkeys(p.first for p in situation.order.precedences if p.second == ego))
    ahead = {action: gain for action, gain in reached.items() if action in allowed}
    if not ahead:
        # Standing does not help a vehicle that has to go first; something safe has to be done.
        slow = situation.scene.ego.speed < STANDS
        action, how = (allowed[0], "the fastest") if slow else (allowed[-1], "the slowest")
        kept = f"the order cannot be kept with {waits_for or 'others'}"
        return Decision(ego, action, f"{kept}; {action} is {how} action that is safe")
    best = max(ahead.values())
    # A plan that gets nowhere and reverses is worth less than nothing.
    enough = min(best, best * (1 - TOLERANCE))
    near = [action for action in allowed if ahead.get(action, -math.inf) >= enough]
    action = next((a for a in near if not _takes_back(situation, a)), near[0])
    return Decision(ego, action, _reason(action, allowed, waits_for))


def _takes_back(situation: Situation, action: Action) -> bool:
    """Whether an action reverses what a CAV is doing, where it could hold its speed instead."""
    scene, may_hold = situation.scene, any(a.action is Action.HOLD for a in situation.assessments)
    return may_hold and reverses(action, scene.ego.speed, scene.intent.target_speed)


def _lane_change(situation: Situation, reached: Mapping[Action, float]) -> Decision | None:
    """Change lanes if the route asks for it, or if it gets the CAV clearly farther."""
    scene = situation.scene
    stays = max((gain for action, gain in reached.items() if action not in SIDES), default=0.0)
    if scene.must_change is not None:
        for action in (side for side in SIDES if side in situation.allowed):
            gain = reached.get(action, math.inf)
            if action is scene.must_change.action and gain >= stays - YIELDS:
                room = f"{scene.must_change.room:.0f} m before its lane ends"
                return Decision(scene.ego.id, action, f"the route asks for {action}, which is safe now, {room}")
        return None
    sides = {action: gain for action, gain in reached.items() if action in SIDES}
    # One lane change after another, and none so slowly that it would block both lanes.
    if not sides or scene.covers or scene.ego.speed < SLOWEST_CHANGE:
        return None
    action = max(sides, key=lambda side: sides[side])
    if sides[action] <= stays * (1 + OVERTAKES):
        return None
    return Decision(scene.ego.id, action, f"{action} gets {sides[action] - stays:.0f} m farther than staying")


def _reason(action: Action, allowed: list[Action], waits_for: str) -> str:
    if waits_for:
        return f"{action} still lets {waits_for} pass first"
    if action is Action.FASTER:
        return "no vehicle goes first and accelerating is safe"
    if action is allowed[0]:
        return f"no vehicle goes first, and {action} is the fastest action that is safe"
    return f"no vehicle goes first, and {action} gets farther in the end behind those ahead"


def is_plain(situation: Situation, sees_conflicts: bool) -> bool:
    """Whether a CAV has no vehicle to consider, and its best action is plain.

    It has no vehicle to consider if

    - it is in no conflict, however slight, and in no pair of the order;
    - the vehicle ahead on its lane is so far away that it stays 2 s behind for the next 10 s, the other one
      keeping its speed and the CAV driving as fast as FASTER lets it;
    - where conflicts cannot be seen, since intents are not shared: no vehicle is ahead, on any lane, as near as it gets
      within 10 s.

    Its best action is plain if every action along the lane is safe and keeps the order, it is on one lane only, its
    route asks for no lane change, and the rules say FASTER: no lane change would get it clearly farther either.
    """
    scene = situation.scene
    if situation.conflicts or scene.must_change is not None or scene.covers:
        return False
    if any(scene.ego.id in (p.first, p.second) for p in situation.order.precedences):
        return False
    along = [a for a in situation.assessments if a.action in EAGERNESS]
    if not all(not a.reasons and a.progress is not None for a in along):
        return False
    # Progress is what a plan is worth behind all others, not how far the CAV would drive on its own.
    reach = HORIZON * max([scene.ego.speed, *(a.target or 0.0 for a in along)])
    if any(_catches_up(n, reach) or (not sees_conflicts and _is_ahead(scene, n, reach)) for n in scene.neighbours):
        return False
    return decide_one(situation).action is Action.FASTER


def _catches_up(n: TrackedVehicle, reach: float) -> bool:
    """Whether the CAV comes near a vehicle on its lane within the horizon, or is near it already."""
    if n.role is not Role.LEADING:
        return False
    gap, pace = n.gap or 0.0, reach / HORIZON
    return min(gap, gap + HORIZON * n.speed - reach) < HEADWAY * pace


def _is_ahead(scene: SceneDescription, n: TrackedVehicle, reach: float) -> bool:
    along = math.cos(scene.ego.heading) * (n.x - scene.ego.x) + math.sin(scene.ego.heading) * (n.y - scene.ego.y)
    return 0 < along <= reach
