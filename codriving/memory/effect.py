"""Memory augment: what an action did to the CAV's most urgent conflict, judged by what came of it (Section III-D.1)."""

from collections.abc import Sequence
from itertools import pairwise
from math import cos, sin

from codriving.datatypes.action import Action
from codriving.datatypes.conflict import Conflict
from codriving.datatypes.experience import Effect
from codriving.memory.moments import Moment, Way

HORIZON = 3.0
"""How far ahead a collision or needless waiting is put down to an action [s]."""

CONCERNS = 8.0
"""Beyond this difference of the times to the conflict point there is no danger in the paper's bands [s]."""

STANDS = 0.5
"""Below this speed a vehicle stands [m/s]."""

SLOW = 3.0
"""A CAV that keeps a lower speed than this waits [m/s]."""

SIDEWAYS = (Action.LANE_LEFT, Action.LANE_RIGHT)

BEHIND = 2.0
"""Whoever drives up to this time behind on the same lane is in the way of whoever slows down or cuts in [s]."""

FREE = 2.0
"""A leader this far ahead leaves the way free, but never nearer than ten metres [s]."""


def effect_of(way: Way, k: int) -> Effect:
    """Judge one action."""
    now, after = way.moments[k], _at(way, k + 1)
    collision = _collision(way, k)
    conflict = _judged(now, None if collision is None or way.crash is None else way.crash.other)
    later = None if conflict is None or after is None else _same(conflict, after.conflicts)
    change = 0.0 if conflict is None or later is None else own_change(conflict, later, now.ego.speed * way.interval)
    return Effect(
        dttcp_before=None if conflict is None else round(conflict.dttcp, 3),
        dttcp_after=None if later is None else round(later.dttcp, 3),
        own_change=round(change, 3),
        own_braking=round(_own_braking(way, k), 3),
        forced_braking=round(_forced_braking(way, k, conflict, change), 3),
        collision=None if collision is None else round(collision, 3),
        to_blame=collision is not None and _is_to_blame(way, k, conflict, change),
        needless=_needless(way, k),
    )


def own_change(before: Conflict, after: Conflict, kept: float) -> float:
    """Return by how much a CAV's own action widened the difference of the times to the conflict point.

    The difference as it is after the step is compared with what it would be had the CAV kept its speed. What the other
    one did is on both sides.

    Args:
        kept: How far the CAV would have got at the same speed [m].

    Returns:
        Time [s]; negative if the action narrowed it. 0 once either is in the zone.
    """
    if min(*before.distances, *after.distances) <= 0:
        return 0.0
    left = max(before.distances[0] - kept, 0.0) / before.distances[0]
    return abs(after.ttcp[0] - after.ttcp[1]) - abs(left * before.ttcp[0] - after.ttcp[1])


def _at(way: Way, k: int) -> Moment | None:
    return way.moments[k] if 0 <= k < len(way.moments) else None


def _judged(now: Moment, crashed_with: str | None) -> Conflict | None:
    """The conflict with whoever it then collided with, or else the most urgent one, if it is in any danger at all."""
    with_it = next((c for c in now.conflicts if c.other == crashed_with), None)
    if with_it is not None:
        return with_it
    return next((c for c in now.conflicts if c.dttcp <= CONCERNS), None)


def _same(conflict: Conflict, later: Sequence[Conflict]) -> Conflict | None:
    """The same conflict a step later; None if it is over."""
    key = (conflict.other, conflict.routes, conflict.zone)
    return next((c for c in later if (c.other, c.routes, c.zone) == key), None)


def _collision(way: Way, k: int) -> float | None:
    if way.crash is None:
        return None
    ahead = way.crash.time - k * way.interval
    return ahead if 0 <= ahead <= HORIZON else None


def _is_to_blame(way: Way, k: int, conflict: Conflict | None, change: float) -> bool:
    """Whether an action led to the collision that came soon after."""
    assert way.crash is not None
    end = min(len(way.moments), 1 + int(way.crash.time / way.interval))
    before = way.moments[max(0, end - 1 - round(HORIZON / way.interval)) : end]
    action = way.moments[k].action
    if any(m.action in SIDEWAYS for m in before):
        return action in SIDEWAYS
    met = conflict is not None and conflict.other == way.crash.other
    if action is Action.SLOWER:
        return met and change < 0
    return met or way.crash.striker


def _deceleration(before: float, after: float, interval: float) -> float:
    return max(0.0, (before - after) / interval)


def _own_braking(way: Way, k: int) -> float:
    """How hard the CAV had to brake in the step after this one; what it did itself now is no consequence."""
    one, two = _at(way, k + 1), _at(way, k + 2)
    if one is None or two is None:
        return 0.0
    return _deceleration(one.ego.speed, two.ego.speed, way.interval)


def _forced_braking(way: Way, k: int, conflict: Conflict | None, change: float) -> float:
    """How hard those brake whom the action concerns: who drives behind, and whom it has come closer to."""
    now = way.moments[k]
    concerned = {name for name in now.others if _is_behind(way, k, name)}
    if conflict is not None and change < 0:
        concerned.add(conflict.other)
    return max((_braking(way, k, name) for name in concerned), default=0.0)


def _braking(way: Way, k: int, name: str) -> float:
    """Hardest mean deceleration in this or the next step of somebody who was not braking as hard before."""
    speeds = [m.others[name].speed if m is not None and name in m.others else None for m in _four(way, k)]
    drops = [_deceleration(a, b, way.interval) if a is not None and b is not None else 0.0 for a, b in pairwise(speeds)]
    return max(max(drops[1:]) - drops[0], 0.0)


def _four(way: Way, k: int) -> list[Moment | None]:
    return [_at(way, n) for n in range(k - 1, k + 3)]


def _is_behind(way: Way, k: int, name: str) -> bool:
    """Whether somebody drives close behind the CAV on the lane that it is on after the step."""
    after = _at(way, k + 1)
    if after is None or name not in after.others:
        return False
    ego, other = after.ego, after.others[name]
    dx, dy = ego.x - other.x, ego.y - other.y
    ahead = cos(other.heading) * dx + sin(other.heading) * dy
    aside = abs(cos(other.heading) * dy - sin(other.heading) * dx)
    return other.lane == ego.lane and 0 < ahead < (ego.length + other.length) / 2 + BEHIND * other.speed and aside < 2.0


def _needless(way: Way, k: int) -> bool:
    """Whether the CAV waited although it could have gone and nobody then used the way."""
    now = way.moments[k]
    waits = now.action is Action.SLOWER or (now.action is Action.IDLE and now.ego.speed < SLOW)
    if not waits or not now.could_go or _collision(way, k) is not None:
        return False
    if now.lead_gap is not None and now.lead_gap < max(10.0, FREE * now.ego.speed):
        return False
    window = way.moments[k : k + 1 + round(HORIZON / way.interval)]
    if len(window) <= round(HORIZON / way.interval):
        return False
    for c in now.conflicts:
        far = c.dttcp > CONCERNS and c.ttcp[1] > HORIZON
        if c.distances[1] <= 0 or not (far or all(_stands(m, c.other) for m in window)):
            return False
    return True


def _stands(moment: Moment, name: str) -> bool:
    other = moment.others.get(name)
    return other is None or other.speed < STANDS
