"""What joint actions cost: risk of one another and of human drivers, loss of speed, acceleration."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from codriving.datatypes.scene_description import TrackedVehicle
from codriving.geometry.path import Path
from codriving.methods.coop_game_fuzzy.joint_choice import Array, Costs
from codriving.methods.coop_game_fuzzy.risk_field import Body, risk
from codriving.reasoning.execution.stage import Stage

YIELDS_AFTER = 2.0
"""A driver who has been standing for this long keeps its place [s]."""


@dataclass(frozen=True, slots=True)
class Weights:
    """How much each term counts.

    Attributes:
        reference_acceleration: Acceleration that costs the whole weight of comfort [m/s2].
    """

    risk: float
    efficiency: float
    comfort: float
    reference_acceleration: float


def joint_costs(
    stage: Stage, vehicles: Mapping[str, TrackedVehicle], travels: Mapping[str, Array], samples: int, weights: Weights
) -> Costs:
    """Return what joint actions cost: the greatest risk from each other vehicle, and the means of the other terms.

    Args:
        travels: Distance of each option over time, by id (options, steps + 1) [m].
    """
    forecast, top = stage.forecast, stage.forecast.model.target_speeds[-1]
    places = np.array([travels[v.id][:, :samples] for v in vehicles.values()])
    speeds = np.gradient(places, forecast.sample, axis=2)
    accelerations = np.gradient(speeds, forecast.sample, axis=2)
    own = weights.efficiency * ((top - speeds) ** 2).mean(axis=2) / top**2
    own += weights.comfort * (accelerations**2).mean(axis=2) / weights.reference_acceleration**2
    bodies = [
        body(stage.road_map.paths[v.routes[0][0]], v.routes[0][1] + p, s)
        for v, p, s in zip(vehicles.values(), places, speeds, strict=True)
    ]
    for i, (name, where) in enumerate(zip(vehicles, bodies, strict=True)):
        own[i] += weights.risk * human_risk(stage, name, where, samples, top)
    x, y, heading, speed = (np.array([getattr(b, key) for b in bodies]) for key in ("x", "y", "heading", "speed"))
    met = risk(x[:, :, None, None], y[:, :, None, None], Body(x, y, heading, speed), top).max(axis=4)
    met[np.arange(len(bodies)), :, np.arange(len(bodies)), :] = 0.0
    return Costs(own, weights.risk * met)


def body(path: Path, places: Array, speeds: Array) -> Body:
    """Return where a vehicle is.

    Args:
        places: Its arc length there [m].
        speeds: Its speed, in the same shape [m/s].
    """
    x, y = path.position(places)
    return Body(x, y, path.heading(places), speeds)


def human_risk(stage: Stage, ego: str, where: Body, samples: int, top_speed: float) -> Array:
    """Return the risk from human drivers, each where it is most dangerous of all places at which it is expected.

    Args:
        top_speed: Speed at which the field has its full length [m/s].

    Returns:
        Greatest risk of each option from each of them, added up (options,).
    """
    found = np.zeros(len(where.x))
    for other in stage.known[ego].values():
        if other.is_cav:
            continue
        low, high = stage.forecast.likely(other.speed)
        if other.standing >= YIELDS_AFTER:
            low, high = np.zeros_like(low), np.zeros_like(high)
        # The interval is up to 12 m long: its middle and its ends are close enough for a field of this length.
        reached = np.array([low, (low + high) / 2, high])[:, :samples]
        dangers = []
        for route, place in other.routes:
            source = body(stage.road_map.paths[route], place + reached, np.full_like(reached, other.speed))
            dangers.append(risk(where.x[:, None, :], where.y[:, None, :], source, top_speed).max(axis=1))
        found += np.max(dangers, axis=0).max(axis=1)
    return found
