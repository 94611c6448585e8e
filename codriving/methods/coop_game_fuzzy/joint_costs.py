"""What joint actions cost: risk of one another and of human drivers, loss of speed, acceleration."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from codriving.datatypes import TrackedVehicle
from codriving.geometry import Path
from codriving.methods.coop_game_fuzzy.joint_choice import Array, Costs
from codriving.reasoning import Moment

YIELDS_AFTER = 2.0  # A driver who has been standing for this long keeps its place [s]

# Semi-axes at which the risk has fallen to 1/e, along the vehicle at top speed and across it [m].
ALONG, ACROSS = 8.0, 2.5

STANDING = 0.5  # Share of the length of the field that is left around a standing vehicle


@dataclass(frozen=True, slots=True)
class Poses:
    """Centre [m], heading [rad] and speed [m/s] of a vehicle over time; the shapes of all four can be broadcast."""

    x: Array
    y: Array
    heading: Array
    speed: Array


@dataclass(frozen=True, slots=True)
class Weights:
    """How much each term counts."""

    risk: float
    efficiency: float
    comfort: float
    reference_acceleration: float  # Acceleration that costs the whole weight of comfort [m/s2]


def joint_costs(
    moment: Moment, vehicles: Mapping[str, TrackedVehicle], travels: Mapping[str, Array], samples: int, weights: Weights
) -> Costs:
    """Return what joint actions cost: the greatest risk from each other vehicle, and the means of the other terms."""
    forecast, top = moment.forecast, moment.forecast.model.target_speeds[-1]
    places = np.array([travels[v.id][:, :samples] for v in vehicles.values()])
    speeds = np.gradient(places, forecast.sample, axis=2)
    accelerations = np.gradient(speeds, forecast.sample, axis=2)
    own = weights.efficiency * ((top - speeds) ** 2).mean(axis=2) / top**2
    own += weights.comfort * (accelerations**2).mean(axis=2) / weights.reference_acceleration**2
    motions = zip(vehicles.values(), places, speeds, strict=True)
    bodies = [poses(moment.road_map.paths[v.routes[0][0]], v.routes[0][1] + p, s) for v, p, s in motions]
    for i, (name, where) in enumerate(zip(vehicles, bodies, strict=True)):
        own[i] += weights.risk * human_risk(moment, name, where, samples, top)
    x, y, heading, speed = (np.array([getattr(b, key) for b in bodies]) for key in ("x", "y", "heading", "speed"))
    met = risk(x[:, :, None, None], y[:, :, None, None], Poses(x, y, heading, speed), top).max(axis=4)
    met[np.arange(len(bodies)), :, np.arange(len(bodies)), :] = 0.0
    return Costs(own, weights.risk * met)


def poses(path: Path, places: Array, speeds: Array) -> Poses:
    """Return where a vehicle is at some arc lengths [m], in their shape."""
    x, y = path.position(places)
    return Poses(x, y, path.heading(places), speeds)


def human_risk(moment: Moment, ego: str, where: Poses, samples: int, top_speed: float) -> Array:
    """Return the risk from human drivers, each where it is most dangerous of all places at which it is expected."""
    found = np.zeros(len(where.x))
    for other in moment.vehicles[ego].values():
        if other.is_cav:
            continue
        dangers = []
        for route, place in other.routes:
            low, high = moment.forecast.likely_of(other, (route, place))
            if other.standing >= YIELDS_AFTER:
                low, high = np.zeros_like(low), np.zeros_like(high)
            # The interval is up to 12 m long: its middle and its ends are close enough for a field of this length.
            reached = np.array([low, (low + high) / 2, high])[:, :samples]
            source = poses(moment.road_map.paths[route], place + reached, np.full_like(reached, other.speed))
            dangers.append(risk(where.x[:, None, :], where.y[:, None, :], source, top_speed).max(axis=1))
        found += np.max(dangers, axis=0).max(axis=1)
    return found


def risk(x: Array, y: Array, source: Poses, top_speed: float) -> Array:
    """Return the risk of being at a place [m]: 1 at the middle of the vehicle, falling to 0 far from it.

    The field is Gaussian, longer along the vehicle, and has its full length at the top speed [m/s].
    """
    dx, dy = x - source.x, y - source.y
    cos, sin = np.cos(source.heading), np.sin(source.heading)
    length = ALONG * (STANDING + (1 - STANDING) * np.clip(source.speed / top_speed, 0.0, 1.0))
    return np.asarray(np.exp(-(((cos * dx + sin * dy) / length) ** 2) - ((cos * dy - sin * dx) / ACROSS) ** 2))
