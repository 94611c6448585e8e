"""State sharing, SAE J3216 class A: what each CAV knows of the others' states (paper Section III-C.1)."""

from math import hypot
from typing import Protocol

from codriving.datatypes.driving_model import DrivingModel
from codriving.datatypes.scene_description import TrackedVehicle
from codriving.datatypes.vehicle import VehicleState
from codriving.datatypes.world import WorldState
from codriving.geometry.box import TRUE

USUAL_LENGTH = TRUE.length
"""Length that is assumed of a vehicle which is only sensed [m]."""

Views = dict[str, tuple[TrackedVehicle, ...]]
"""Vehicles that each CAV knows of, by id of the CAV."""


class StateSharing(Protocol):
    """Turns the world into what each CAV knows of it."""

    def views(self, world: WorldState, model: DrivingModel) -> Views:
        """Return the vehicles that each CAV knows of."""
        ...


class SharedStates:
    """CAVs tell one another their own states, and the human drivers that any of them perceives."""

    def views(self, world: WorldState, model: DrivingModel) -> Views:
        """Return the same full states for everybody: all CAVs, and every HDV within range of at least one of them."""
        cavs = world.cavs
        seen = [h for h in world.hdvs if any(_within(c, h, model.detection_range) for c in cavs)]
        known = tuple(_full(v) for v in sorted((*cavs, *seen), key=lambda v: v.id))
        return {cav.id: tuple(g for g in known if g.id != cav.id) for cav in cavs}


class SensedStates:
    """Without state sharing: only position and speed of vehicles within the detection range (paper Section IV-B)."""

    def views(self, world: WorldState, model: DrivingModel) -> Views:
        """Return what each CAV's own sensors tell."""
        return {
            cav.id: tuple(
                TrackedVehicle(v.id, None, v.x, v.y, v.speed, None, None, None, USUAL_LENGTH)
                for v in world.vehicles
                if v.id != cav.id and _within(cav, v, model.detection_range)
            )
            for cav in world.cavs
        }


class WatchedStates:
    """A vehicle on its own: position, speed and heading of whoever is within range, and never who drives it.

    Lanes are left out, since a simulator knows on which of two lanes one above the other a vehicle is by its route.
    """

    def views(self, world: WorldState, model: DrivingModel) -> Views:
        """Return what each CAV's own sensors tell."""
        return {
            cav.id: tuple(
                TrackedVehicle(v.id, None, v.x, v.y, v.speed, v.heading, None, None, USUAL_LENGTH)
                for v in world.vehicles
                if v.id != cav.id and _within(cav, v, model.detection_range)
            )
            for cav in world.cavs
        }


def _within(one: VehicleState, other: VehicleState, distance: float) -> bool:
    return hypot(one.x - other.x, one.y - other.y) <= distance


def _full(v: VehicleState) -> TrackedVehicle:
    return TrackedVehicle(v.id, v.kind, v.x, v.y, v.speed, v.heading, v.acceleration, v.lane, v.length)
