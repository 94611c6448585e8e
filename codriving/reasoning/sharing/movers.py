"""The vehicles that one CAV knows of, as things that move along routes."""

from dataclasses import dataclass

from codriving.datatypes.scene_description import SceneDescription
from codriving.datatypes.vehicle import Kind


@dataclass(frozen=True, slots=True)
class Mover:
    """A vehicle reduced to what a prediction along routes needs.

    Attributes:
        speed: Speed [m/s].
        target: Target speed, its own or its speed where that is unknown [m/s].
        routes: Each route that it may be on, with its arc length there [m].
        acceleration: Acceleration [m/s2]; None where it is not known.
        standing: How long it has been standing [s].
    """

    id: str
    is_cav: bool
    speed: float
    target: float
    routes: tuple[tuple[str, float], ...]
    acceleration: float | None
    standing: float


def movers(scene: SceneDescription) -> dict[str, Mover]:
    """Return the ego vehicle and its neighbours, by id."""
    ego = scene.ego
    route = ((scene.intent.route, scene.place), *scene.covers)
    found = {ego.id: Mover(ego.id, True, ego.speed, scene.intent.target_speed, route, ego.acceleration, 0.0)}
    for n in scene.neighbours:
        is_cav = n.kind == Kind.CAV and n.intent is not None
        target = n.intent.target_speed if n.intent is not None else n.speed
        found[n.id] = Mover(n.id, is_cav, n.speed, target, n.routes, n.acceleration, n.standing)
    return dict(sorted(found.items()))
