"""Human drivers as obstacles of a joint plan: a stretch on every way that they may take, which grows with time."""

import numpy as np

from codriving.datatypes.conflict import Conflict
from codriving.datatypes.scene_description import TrackedVehicle
from codriving.geometry.box import PLANNING, TRUE
from codriving.reasoning.execution.stage import Stage
from codriving.reasoning.execution.violations import SIZES, Array, Steps, meets, passes_too_early
from codriving.reasoning.prediction.expectation import CLEARS, is_behind
from codriving.reasoning.prediction.right_of_way import gives_way

ROOM = 0.5
"""Room that a driver who gives way leaves to the zone [m]."""


def minds_humans(stage: Stage, ego: TrackedVehicle, travels: Array, lag: int, following: int, pad: float) -> Steps:
    """Return when each plan of a CAV first comes too close to a human driver.

    Whoever drives behind on the same way has to mind the CAV, not the other way round; whoever gives way, by standing
    or by the rules of the road, is expected to stay before the zone.

    Args:
        travels: Distance of each plan over time (plans, n) [m].
        pad: Additional room along the route [m].

    Returns:
        Step of the first violation (plans,); n where there is none.
    """
    found: Steps = np.full(len(travels), travels.shape[1])
    people = {m.id: m for m in stage.known[ego.id].values() if not m.is_cav}
    for other in people.values():
        found = np.minimum(found, _drives_ahead(stage, ego, other, travels, following))
    for c in stage.conflicts[ego.id]:
        if c.other in people:
            found = np.minimum(found, _in_zone(stage, c, people[c.other], travels, lag, pad))
    return found


def _drives_ahead(stage: Stage, ego: TrackedVehicle, other: TrackedVehicle, travels: Array, following: int) -> Steps:
    n = travels.shape[1]
    found: Steps = np.full(len(travels), n)
    low, _ = stage.forecast.likely(other.speed)
    for k, (route, place) in enumerate(ego.routes):
        # A lane that the CAV is leaving is minded until its body is off it.
        until = n if k == 0 else round(CLEARS / stage.forecast.sample) + 1
        for way, there in other.routes:
            for zone in stage.road_map.zones(route, way):
                if is_behind(zone, place, there):
                    steps = passes_too_early(zone, place + travels[:, :until], there + low, following, 0.0)
                    found = np.minimum(found, np.where(steps < until, steps, n))
    return found


def _in_zone(stage: Stage, c: Conflict, other: TrackedVehicle, travels: Array, lag: int, pad: float) -> Steps:
    place, there = c.places
    low, high = stage.forecast.likely(other.speed)
    yields = gives_way(c, other, stage.road_map)
    steps: Steps = np.zeros(len(travels), dtype=np.int64)
    # Beside somebody who gives way the bodies have to keep clear, no more.
    for size in SIZES[1:] if yields else SIZES:
        whole, apart = size is PLANNING, not yields and size is not TRUE
        # One zone of the larger footprint may be several of the smaller one.
        zones = stage.road_map.zones(*c.routes, size)
        for zone in (zones[c.zone],) if whole else zones:
            room = max(zone.entry_j - there - ROOM, 0.0) if yields else np.inf
            touched = meets(
                zone,
                place + travels,
                there + np.minimum(low, room),
                there + np.minimum(high, room),
                lag if apart else 0,
                pad if apart else 0.0,
            )
            steps = touched if zone is zones[0] or whole else np.minimum(steps, touched)
        if steps.any() or not zones:
            return steps if zones else np.full(len(travels), travels.shape[1])
    return steps
