"""When human drivers may use a conflict zone, and whether a CAV is through before."""

from collections.abc import Iterable

from codriving.datatypes.conflict import Conflict
from codriving.datatypes.scene_description import SceneDescription, TrackedVehicle
from codriving.geometry.box import TRUE
from codriving.geometry.road_map import RoadMap
from codriving.reasoning.ordering.separation import GAP, lag_length
from codriving.reasoning.prediction.forecast import Forecast
from codriving.reasoning.prediction.right_of_way import gives_way

CERTAIN_GAP = 0.4
"""Time between a CAV's leaving a zone and the earliest moment at which a human driver can be there [s]."""


def window(
    c: Conflict, n: TrackedVehicle, reference: float, road_map: RoadMap, forecast: Forecast
) -> tuple[float, float]:
    """Return the times at which a CAV must not pass its reference point because of a human driver.

    Args:
        reference: Arc length of the CAV's reference point [m].

    Returns:
        Begin and end, inf for a driver who gives way [s].
    """
    if gives_way(c, n, road_map):
        return float("inf"), float("inf")
    zone = road_map.zones(*c.routes)[c.zone]
    top = forecast.model.target_speeds[-1]
    slow, fast = forecast.likely(n.speed)
    enters = forecast.time_to(c.distances[1], fast)
    leaves = forecast.time_to(zone.entry_i + lag_length(zone, False) - c.places[1], slow)
    begin = enters - (zone.entry_j + lag_length(zone) - reference) / top - CERTAIN_GAP
    return begin, leaves + GAP - (zone.entry_i - reference) / top


def passes_first(
    scene: SceneDescription, n: TrackedVehicle, conflicts: Iterable[Conflict], road_map: RoadMap, forecast: Forecast
) -> bool:
    """Whether a CAV that accelerates is through all its conflicts with a human driver before that one can be there."""
    travel = forecast.reach(scene.ego.speed, True).most
    for c in conflicts:
        reference = scene.place + c.distances[0]
        begin, _ = window(c, n, reference, road_map, forecast)
        if forecast.time_to(c.distances[0], travel) > begin:
            return False
    return True


def is_blocked(c: Conflict, road_map: RoadMap) -> bool:
    """Whether the other vehicle stands bodily in the way of the CAV."""
    zones = road_map.zones(*c.routes, TRUE)
    return any(z.entry_j < c.places[1] < z.exit_j and c.places[0] <= float(z.front(c.places[1])) for z in zones)
