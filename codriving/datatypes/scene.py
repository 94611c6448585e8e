"""Where each vehicle starts: the seeded beginning of one episode."""

from dataclasses import dataclass

from codriving.datatypes.vehicle import Kind


@dataclass(frozen=True, slots=True)
class Start:
    """The beginning of one vehicle."""

    id: str
    kind: Kind
    route: str
    position: float  # Arc length along the route [m]
    speed: float  # Initial speed [m/s]


@dataclass(frozen=True, slots=True)
class Scene:
    """Everything that the seed decides before the first step."""

    seed: int
    starts: tuple[Start, ...]
