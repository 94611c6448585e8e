"""Where everybody starts: the seeded beginning of one episode."""

from dataclasses import dataclass

from codriving.datatypes.vehicle import Kind


@dataclass(frozen=True, slots=True)
class Start:
    """The beginning of one vehicle.

    Attributes:
        position: Arc length along the route [m].
        speed: Initial speed [m/s].
    """

    id: str
    kind: Kind
    route: str
    position: float
    speed: float


@dataclass(frozen=True, slots=True)
class Scene:
    """Everything that the seed decides before the first step."""

    seed: int
    starts: tuple[Start, ...]
