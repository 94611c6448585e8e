"""Everything that a frame shows, as plain data; where it comes from is somebody else's business."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from codriving.datatypes.action import Action
from codriving.datatypes.conflict import Severity
from codriving.datatypes.outcome import Outcome
from codriving.datatypes.vehicle import Kind


@dataclass(frozen=True, slots=True)
class Body:
    """A vehicle on the road.

    Attributes:
        x: Position [m].
        y: Position [m].
        heading: Heading [rad].
        speed: Speed [m/s].
        route: Id of the planned route; None for a human driver, whose mind nobody reads.
        length: Length [m].
        width: Width [m].
    """

    id: str
    kind: Kind
    x: float
    y: float
    heading: float
    speed: float
    route: str | None = None
    length: float = 5.0
    width: float = 2.0


@dataclass(frozen=True, slots=True)
class Meeting:
    """An open conflict between two vehicles.

    Attributes:
        dttcp: The time difference [s].
        ways: Route of each, with the arc length at which it comes to where they would meet [m]; None if that is not
            known.
    """

    one: str
    other: str
    severity: Severity
    dttcp: float
    certain: bool
    ways: tuple[tuple[str, float], tuple[str, float]] | None = None


@dataclass(frozen=True, slots=True)
class Thought:
    """What a CAV decided."""

    action: Action | None
    reason: str = ""
    waits_for: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Moment:
    """One moment of an episode.

    Attributes:
        time: Simulated time [s].
        order: The passing order, first to last; None if there is none that all share.
        arrived: Arrival time of each CAV that has arrived [s], by id; None if it is not known when.
    """

    time: float
    bodies: tuple[Body, ...]
    thoughts: Mapping[str, Thought] = field(default_factory=dict)
    meetings: tuple[Meeting, ...] = ()
    order: tuple[str, ...] | None = None
    order_title: str = ""
    arrived: Mapping[str, float | None] = field(default_factory=dict)
    outcome: Outcome | None = None
