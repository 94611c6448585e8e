"""First layer: no collision with the vehicles of the same lane, ahead or behind (Section III-C.4)."""

from math import ceil

import numpy as np

from codriving.datatypes import Action, Role, TrackedVehicle
from codriving.geometry import Array, stays_behind
from codriving.reasoning.conflicts import is_behind
from codriving.reasoning.safety.safety_input import SafetyInput

STANDSTILL_GAP = 1.0  # Free distance that must be left to the leading vehicle when both have stopped [m]

LANE_END_GAP = 2.0  # Room that a CAV which has to change lanes and cannot must still have when it has stopped [m]

# Distance from the centre of a vehicle to the end of a lane at which it is clear of what may stand there [m].
END = 4.0

ABRUPT = 4.0  # Braking that must not be forced on the rearing vehicle [m/s2]

REACTION = 0.5  # Time after which the rearing vehicle begins to brake [s]


def check_ahead(given: SafetyInput) -> dict[Action, list[str]]:
    """Remove actions after which the CAV could not stop behind the vehicle ahead if it brakes hard."""
    found: dict[Action, list[str]] = {}
    travelled = given.stops - given.scene.place
    # While it changes lanes, the CAV is on two of them.
    ways = [
        (own, place, given.forecast.clears if k else given.forecast.steps + 1)
        for k, (own, place) in enumerate(given.vehicles[given.scene.ego.id].routes)
    ]
    for n in given.scene.neighbours:
        there = given.vehicles[n.id]
        ahead = [
            (zone, place, other, until)
            for own, place, until in ways
            for route, other in there.routes
            for zone in given.road_map.zones(own, route)
            if is_behind(zone, place, other)
        ]
        gap = n.gap if n.role is Role.LEADING else None
        if not ahead and gap is None:
            continue
        least = given.forecast.reach_of(there, there.routes[0]).least
        keeps = np.ones(len(given.actions), dtype=np.bool_)
        if gap is not None:
            keeps &= (gap + least - travelled >= min(STANDSTILL_GAP, gap)).all(axis=1)
        for zone, place, other, until in ahead:
            keeps &= stays_behind(zone, place + travelled[:, :until], other + least[:until], 0, 0.0)
        for action, safe in zip(given.actions, keeps, strict=True):
            if not safe:
                found.setdefault(action, []).append(
                    f"same lane: {action} leaves too little room to stop behind {n.id} at {n.speed:.1f} m/s"
                )
    for action in _meets_the_end(given, travelled):
        found.setdefault(action, []).append(
            f"same lane: {action} leaves too little room to stop where the lane ends that the CAV leaves"
        )
    change = given.scene.must_change
    if change is not None:
        for action, reached in zip(given.actions, travelled[:, -1], strict=True):
            if reached > change.room - LANE_END_GAP:
                found.setdefault(action, []).append(
                    f"same lane: after {action} the CAV could not stop before its lane ends, {change.room:.0f} m ahead"
                )
    return found


def _meets_the_end(given: SafetyInput, travelled: Array) -> list[Action]:
    """Return the actions after which a CAV that changes lanes could not stop before the end of the lane it leaves.

    Without limits a body is off that lane before there is anything to mind.
    """
    forecast, scene = given.forecast, given.scene
    if forecast.model.limits is None:
        return []
    found: list[Action] = []
    for name, place in scene.covers:
        left = given.road_map.changes.ahead(name, place)
        if left is not None:
            _, offset = given.road_map.project(scene.intent.route, scene.ego.x, scene.ego.y)
            takes = forecast.model.limits.clears_after(given.road_map.widest, abs(offset))
            reached = place + travelled[:, min(ceil(takes / forecast.sample), forecast.steps)]
            found += [a for a, s in zip(given.actions, reached.tolist(), strict=True) if s + END > left[2]]
    return found


def check_behind(given: SafetyInput) -> dict[Action, list[str]]:
    """Remove actions that force the rearing vehicle to brake abruptly."""
    behind = given.scene.next_in(Role.REARING)
    if behind is None or behind.gap is None:
        return {}
    found: dict[Action, list[str]] = {}
    for action, goes in zip(given.actions, given.goes, strict=True):
        braking = forced_braking(given, behind, goes)
        if braking > ABRUPT:
            found[action] = [f"same lane: {action} would force {behind.id} behind to brake at {braking:.1f} m/s2"]
    return found


def forced_braking(given: SafetyInput, behind: TrackedVehicle, goes: Array) -> float:
    """Return how hard the rearing vehicle would have to brake to come down to the CAV's speed."""
    forecast = given.forecast
    done = max(1, int(np.searchsorted(forecast.times, forecast.model.decision_interval + 1e-9)) - 1)
    closing = behind.speed - float(goes[done] - goes[done - 1]) / forecast.sample
    if closing <= 0 or behind.gap is None:
        return 0.0
    room = behind.gap + float(goes[done] - goes[0]) - behind.speed * REACTION
    return closing**2 / (2 * room) if room > 0.1 else float("inf")
