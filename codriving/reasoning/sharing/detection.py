"""One vehicle as another one knows it, before it is put in relation to anything."""

from dataclasses import dataclass

from codriving.datatypes.road import LaneId


@dataclass(frozen=True, slots=True)
class Glimpse:
    """What is known of a vehicle; None where nothing is.

    Attributes:
        kind: ``CAV`` or ``HDV``.
        x: Position [m].
        y: Position [m].
        speed: Speed [m/s].
        heading: Heading [rad].
        acceleration: Acceleration [m/s2].
        length: Vehicle length [m].
    """

    id: str
    kind: str | None
    x: float
    y: float
    speed: float
    heading: float | None
    acceleration: float | None
    lane: LaneId | None
    length: float
