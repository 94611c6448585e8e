"""Second layer: a lane change must not collide with the vehicles of the adjacent lane (Section III-C.4)."""

from codriving.datatypes import Action, SceneDescription, TrackedVehicle
from codriving.reasoning.conflicts import is_behind
from codriving.reasoning.safety.conflict_lane import check_conflicts
from codriving.reasoning.safety.safety_input import SIDES, SafetyInput
from codriving.reasoning.safety.same_lane import check_ahead

MARGIN = 2.0  # Free distance to keep to the one behind [m]

HEADWAY = 0.5  # Time gap to leave to the one behind [s]

COMFORT = 4.0  # Braking that the one behind may be asked for [m/s2]

# Distance along the road within which a vehicle on the far side of the lane could change onto it as well [m]; where
# the one behind is faster, what it gains until it has seen the change and has braked to the other's speed is added.
SIDE_GAP = 8.0

SEEN_AFTER = 1.0  # Time after which the one behind brakes for a vehicle that changed onto the lane with it [s]

HELD_UP = -0.3  # Below this acceleration a human driver is held up and may want to change lanes [m/s2]


def check_adjacent(given: SafetyInput) -> dict[Action, list[str]]:
    """Remove lane changes after which the CAV could not stop behind who is ahead there, or cuts in on who is behind."""
    found: dict[Action, list[str]] = {}
    must = given.scene.must_change is not None
    for action in given.actions:
        if action not in SIDES:
            continue
        there = given.beside(action)
        if there is None:
            found[action] = ["adjacent lane: it does not lead where the CAV goes"]
            continue
        reasons = [*check_ahead(there).get(Action.IDLE, ()), *check_conflicts(there).get(Action.IDLE, ())]
        reasons = [reason.split(": ", 1)[-1].replace(Action.IDLE, action) for reason in reasons]
        reasons += [
            said for n in there.scene.neighbours if (said := _cuts_in(there, n) or _meets(there, n, action, must))
        ]
        if reasons:
            found[action] = [f"adjacent lane: {reason}" for reason in reasons]
    return found


def _cuts_in(there: SafetyInput, n: TrackedVehicle) -> str:
    """Say that a vehicle behind on the new lane could not brake in time, if it could not."""
    ego = there.scene.ego
    for route, place in n.routes:
        for zone in there.road_map.zones(route, there.scene.intent.route):
            if not is_behind(zone, place, there.scene.place) and not _alongside(there, n, route, place):
                continue
            gap = there.scene.place - place - (n.length + ego.length) / 2
            needed = MARGIN + HEADWAY * n.speed + max(0.0, (n.speed**2 - ego.speed**2) / (2 * COMFORT))
            if gap < needed:
                return f"{n.id} is {max(gap, 0.0):.0f} m behind there, {needed:.0f} m are needed"
    return ""


def _alongside(there: SafetyInput, n: TrackedVehicle, route: str, place: float) -> bool:
    scene = there.scene
    return route == scene.intent.route and abs(place - scene.place) < (n.length + scene.ego.length) / 2


def _meets(there: SafetyInput, n: TrackedVehicle, action: Action, must: bool) -> str:
    """Say that a vehicle two lanes away might change onto the same lane, if it is near and does not have to wait."""
    scene = there.scene
    wanted = scene.intent.target_lane[2] + SIDES[action]
    for name, lane in there.road_map.changes.routes_beside(scene.intent.route, scene.intent.target_lane):
        for route, place in n.routes:
            if lane[2] == wanted and route == name and abs(place - scene.place) < _far_side_gap(scene, n, place):
                waits = n.intent is not None and (place, n.id) < (scene.place, scene.ego.id)
                calm = must and n.intent is None and (n.acceleration or 0.0) > HELD_UP
                if not waits and not calm:
                    return f"{n.id} is alongside on the other side and might change there, too"
    return ""


def _far_side_gap(scene: SceneDescription, n: TrackedVehicle, place: float) -> float:
    """Return the distance along the road from which two vehicles may change onto the lane between them [m]."""
    mine, theirs = (scene.ego.speed, scene.intent.target_speed), (n.speed, n.target)
    behind, ahead = (mine, theirs) if scene.place < place else (theirs, mine)
    closing = max(0.0, max(behind) - min(ahead))
    return SIDE_GAP + SEEN_AFTER * closing + closing**2 / (2 * COMFORT)
