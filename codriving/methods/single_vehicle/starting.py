"""Who has waited long may start: nobody is in the zones ahead, or comes before it is through, and it is its turn."""

from collections.abc import Sequence

from codriving.methods.single_vehicle.encounters import Encounter, passes_by
from codriving.methods.single_vehicle.protocol import View

TURN = 1.0
"""Time by which those who wait start one after another [s]."""

SAME = 0.25
"""Difference of the times for which two have been standing that does not count [s]."""


def may_start(view: View, met: Sequence[Encounter], waited: float, patience: float, clear: float) -> bool:
    """Whether a vehicle has waited long enough, and nobody is in the zones ahead or will be before it is through.

    Args:
        waited: How long it has been standing [s].
        patience: How long it has to have been standing [s].
        clear: Time that others must be away from a zone beyond what the start takes [s].
    """
    if not met or waited < patience or not all(_lets_start(e, view, clear) for e in met):
        return False
    # Of those who stand, whoever has waited longest starts first; its start is seen before the next one's turn.
    name = view.scene.ego.id
    before = {e.other.id for e in met if _stood_longer(e.other.standing, e.other.id, waited, name)}
    return waited >= patience + TURN * len(before)


def _lets_start(e: Encounter, view: View, clear: float) -> bool:
    if e.other.standing > 0:
        return passes_by(e, view.road_map)
    if e.other_inside:
        return False
    go = view.forecast.reach(view.scene.ego.speed, True).most
    through = view.forecast.time_to(e.conflict.exits[0], go)
    return e.conflict.ttcp[1] > through + clear


def _stood_longer(standing: float, other: str, waited: float, name: str) -> bool:
    """Whether somebody who stands is to start before a vehicle that has waited for some time as well."""
    if standing <= 0:
        return False
    return standing > waited + SAME or (standing >= waited - SAME and other < name)
