"""What an action did to the CAV's most urgent conflict, in numbers and as a verdict (paper Section III-D.1)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import cos, sin

from codriving.datatypes import Action, Conflict, Effect, VehicleState, Verdict

HORIZON = 3.0  # How far ahead a collision or needless waiting is put down to an action [s]

# Upper limits of the paper's bands of the difference of the TTCPs: serious, general and slight danger [s].
BANDS = (2.0, 5.0, 8.0)

CLEARLY = 0.3  # A narrower change of the difference of the TTCPs is none [s]

HARD = 4.0  # From this mean deceleration on braking is hard [m/s2]

STANDS = 0.5  # Below this speed a vehicle stands [m/s]

SLOW = 3.0  # A CAV that keeps a lower speed than this waits [m/s]

BEHIND = 2.0  # A vehicle up to this time behind on the same lane is affected by a CAV that slows down or cuts in [s]

FREE = 2.0  # A leader this far ahead leaves the way free, but never nearer than ten metres [s]

SIDEWAYS = (Action.LANE_LEFT, Action.LANE_RIGHT)

# The paper's comment, and its two counterparts; what is neutral is not kept.
LESSONS: Mapping[Verdict, str] = {
    Verdict.INTENSIFIED: "Your action has intensified the conflict; similar actions should be avoided.",
    Verdict.EASED: "Your action has eased the conflict; similar actions are advisable.",
    Verdict.TOO_CAUTIOUS: "Your action was too cautious, no vehicle used the way; similar waiting should be cut short.",
}


@dataclass(frozen=True, slots=True)
class HistoryStep:
    """The world when one CAV decided, and what it decided."""

    ego: VehicleState
    others: Mapping[str, VehicleState]
    conflicts: tuple[Conflict, ...]
    lead_gap: float | None  # Free distance to the vehicle ahead on its lane [m]; None without one
    action: Action | None  # What it decided; None at the end of the episode
    could_go: bool


@dataclass(frozen=True, slots=True)
class OwnCollision:
    """A collision, seen from one of the two."""

    time: float  # When it was, counted from the first step [s]
    other: str
    striker: bool


@dataclass(frozen=True, slots=True)
class DecisionHistory:
    """The decision steps of one CAV until it arrived or the episode ended."""

    steps: tuple[HistoryStep, ...]
    interval: float  # Time between two of them [s]
    collision: OwnCollision | None = None  # The collision that it was in; None if in none

    def at(self, k: int) -> HistoryStep | None:
        """Return a step, or None before the first and after the last."""
        return self.steps[k] if 0 <= k < len(self.steps) else None


def effect_of(history: DecisionHistory, k: int) -> Effect:
    """Work out what one action led to."""
    now, after = history.steps[k], history.at(k + 1)
    collision = _time_to_collision(history, k)
    conflict = _most_urgent(now, None if collision is None or history.collision is None else history.collision.other)
    later = None if conflict is None or after is None else _same(conflict, after.conflicts)
    change = 0.0 if conflict is None or later is None else own_change(conflict, later, now.ego.speed * history.interval)
    return Effect(
        dttcp_before=None if conflict is None else round(conflict.dttcp, 3),
        dttcp_after=None if later is None else round(later.dttcp, 3),
        own_change=round(change, 3),
        own_braking=round(_own_braking(history, k), 3),
        forced_braking=round(_forced_braking(history, k, conflict, change), 3),
        collision=None if collision is None else round(collision, 3),
        to_blame=collision is not None and _is_responsible(history, k, conflict, change),
        needless=_needless(history, k),
    )


def own_change(before: Conflict, after: Conflict, kept: float) -> float:
    """Return by how much a CAV's own action widened the difference of the times to the conflict point.

    The difference as it is after the step is compared with what it would be had the CAV kept its speed. What the other
    one did is on both sides.
    """
    if min(*before.distances, *after.distances) <= 0:
        return 0.0
    left = max(before.distances[0] - kept, 0.0) / before.distances[0]
    return abs(after.ttcp[0] - after.ttcp[1]) - abs(left * before.ttcp[0] - after.ttcp[1])


def verdict_of(effect: Effect, action: Action) -> Verdict:
    """Judge an action by what came of it.

    - *intensified*: it led to a collision soon after, and did not itself clearly move the CAV away from it; or it
      narrowed the difference of the TTCPs and the danger is in a worse band; or another vehicle had to brake hard.
    - *eased*: it widened that difference in serious or general danger.
    - *too cautious*: the CAV waited and no vehicle used the way.
    """
    if (effect.to_blame and effect.own_change <= CLEARLY) or _intensified(effect, action):
        return Verdict.INTENSIFIED
    if effect.needless:
        return Verdict.TOO_CAUTIOUS
    dangerous = effect.dttcp_before is not None and band(effect.dttcp_before) <= 1
    if dangerous and effect.collision is None and effect.own_change > CLEARLY and effect.own_braking < HARD:
        return Verdict.EASED
    return Verdict.NEUTRAL


def band(dttcp: float) -> int:
    """Return the paper's band: 0 serious, 1 general, 2 slight, 3 no danger."""
    return sum(dttcp > limit for limit in BANDS)


def _intensified(effect: Effect, action: Action) -> bool:
    before, after = effect.dttcp_before, effect.dttcp_after
    narrowed = effect.own_change < -CLEARLY
    if narrowed and before is not None and after is not None and band(after) < min(band(before), 2):
        return True
    harsh = max(effect.forced_braking, effect.own_braking if action is not Action.SLOWER else 0.0) >= HARD
    if narrowed and after is not None and band(after) <= 1 and harsh:
        return True
    return action in SIDEWAYS and effect.forced_braking >= HARD


def _most_urgent(now: HistoryStep, collided_with: str | None) -> Conflict | None:
    """The conflict with the vehicle of the collision, or else the most urgent one, if it is in any danger at all."""
    with_it = next((c for c in now.conflicts if c.other == collided_with), None)
    return with_it or next((c for c in now.conflicts if c.dttcp <= BANDS[-1]), None)


def _same(conflict: Conflict, later: Sequence[Conflict]) -> Conflict | None:
    """The same conflict a step later; None if it is over."""
    key = (conflict.other, conflict.routes, conflict.zone)
    return next((c for c in later if (c.other, c.routes, c.zone) == key), None)


def _time_to_collision(history: DecisionHistory, k: int) -> float | None:
    if history.collision is None:
        return None
    ahead = history.collision.time - k * history.interval
    return ahead if 0 <= ahead <= HORIZON else None


def _is_responsible(history: DecisionHistory, k: int, conflict: Conflict | None, change: float) -> bool:
    """Whether an action led to the collision that came soon after."""
    assert history.collision is not None
    end = min(len(history.steps), 1 + int(history.collision.time / history.interval))
    action = history.steps[k].action
    if any(
        step.action in SIDEWAYS for step in history.steps[max(0, end - 1 - round(HORIZON / history.interval)) : end]
    ):
        return action in SIDEWAYS
    met = conflict is not None and conflict.other == history.collision.other
    return met and change < 0 if action is Action.SLOWER else met or history.collision.striker


def _deceleration(before: float | None, after: float | None, interval: float) -> float:
    return 0.0 if before is None or after is None else max(0.0, (before - after) / interval)


def _own_braking(history: DecisionHistory, k: int) -> float:
    """How hard the CAV had to brake in the step after this one; what it did itself now is no consequence."""
    before, after = (None if step is None else step.ego.speed for step in (history.at(k + 1), history.at(k + 2)))
    return _deceleration(before, after, history.interval)


def _forced_braking(history: DecisionHistory, k: int, conflict: Conflict | None, change: float) -> float:
    """How hard the affected vehicles brake: those close behind, and the one that the CAV has come closer to."""
    affected = {name for name in history.steps[k].others if _is_behind(history.at(k + 1), name)}
    if conflict is not None and change < 0:
        affected.add(conflict.other)
    return max((_braking(history, k, name) for name in affected), default=0.0)


def _braking(history: DecisionHistory, k: int, name: str) -> float:
    """Hardest mean deceleration in this or the next step of a vehicle that was not braking as hard before."""
    steps = [history.at(n) for n in range(k - 1, k + 3)]
    speeds = [step.others[name].speed if step is not None and name in step.others else None for step in steps]
    drops = [_deceleration(one, two, history.interval) for one, two in pairwise(speeds)]
    return max(max(drops[1:]) - drops[0], 0.0)


def _is_behind(after: HistoryStep | None, name: str) -> bool:
    """Whether a vehicle drives close behind the CAV on the lane that it is on after the step."""
    if after is None or name not in after.others:
        return False
    ego, other = after.ego, after.others[name]
    dx, dy = ego.x - other.x, ego.y - other.y
    ahead = cos(other.heading) * dx + sin(other.heading) * dy
    aside = abs(cos(other.heading) * dy - sin(other.heading) * dx)
    return other.lane == ego.lane and 0 < ahead < (ego.length + other.length) / 2 + BEHIND * other.speed and aside < 2.0


def _needless(history: DecisionHistory, k: int) -> bool:
    """Whether the CAV waited although it could have gone and no vehicle then used the way."""
    now, steps = history.steps[k], round(HORIZON / history.interval)
    waits = now.action is Action.SLOWER or (now.action in (Action.IDLE, Action.HOLD) and now.ego.speed < SLOW)
    if not waits or not now.could_go or _time_to_collision(history, k) is not None:
        return False
    if now.lead_gap is not None and now.lead_gap < max(10.0, FREE * now.ego.speed):
        return False
    window = history.steps[k : k + 1 + steps]
    return len(window) > steps and all(_left_free(c, window) for c in now.conflicts)


def _left_free(conflict: Conflict, window: Sequence[HistoryStep]) -> bool:
    """Whether the other vehicle of a conflict was too far away to use the way, or stood all the time."""
    if conflict.distances[1] <= 0:
        return False
    states = [step.others.get(conflict.other) for step in window]
    far = conflict.dttcp > BANDS[-1] and conflict.ttcp[1] > HORIZON
    return far or all(state is None or state.speed < STANDS for state in states)
