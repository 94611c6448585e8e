"""Whether somebody who has waited long may start: nobody is in the zones ahead, or comes before it is through."""

from codriving.single_vehicle.encounters import Encounter, passes_by
from codriving.single_vehicle.protocol import View


def lets_start(e: Encounter, view: View, clear: float) -> bool:
    """Whether a vehicle may start into one zone.

    Args:
        e: The zone, and the other one.
        view: What the vehicle sees.
        clear: Time that the other one must be away from the zone beyond what the start takes [s].
    """
    if e.other.standing > 0:
        return passes_by(e, view.road_map)
    if e.other_inside:
        return False
    go = view.forecast.reach(view.scene.ego.speed, True).most
    through = view.forecast.time_to(e.conflict.exits[0], go)
    return e.conflict.ttcp[1] > through + clear
