"""What is kept of an episode: what was driven, how it ended and how it scored, as tables are made from it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING, Literal

from codriving.datatypes.world import Kind

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

# Style of who stands in the way of others because the scene has it so; measures of human drivers leave it out.
BLOCKER = "blocker"


@dataclass(frozen=True, slots=True)
class Track:
    """The recorded motion of one vehicle, from its start until it left the road."""

    id: str
    kind: Kind
    route: str
    first_step: int
    x: "NDArray[np.float64]"  # Position of the centre (n,) [m]
    y: "NDArray[np.float64]"  # Position of the centre (n,) [m]
    heading: "NDArray[np.float64]"  # (n,) [rad]
    speed: "NDArray[np.float64]"  # (n,) [m/s]
    acceleration: "NDArray[np.float64]"  # (n,) [m/s2]
    action: tuple[str, ...]  # Name of the action in force at each row (n,); empty for HDVs
    arrived: float | None  # Time of arrival [s], or None
    length: float = 5.0  # [m]
    width: float = 2.0  # [m]
    style: str = ""  # Style of a human driver, where drivers have one


@dataclass(frozen=True, slots=True)
class Trajectory:
    """The motion of all vehicles of one episode."""

    step: float  # Time between two rows [s]
    tracks: tuple[Track, ...]
    # Arc length along its route of each vehicle at each step from its start on (n,) [m], had it driven alone; worked
    # out for metrics that ask for it, and not stored.
    alone: "Mapping[str, NDArray[np.float64]]" = field(default_factory=dict)


class Ending(StrEnum):
    """The ways in which an episode ends; ``error`` is never counted as driving, and a flow is ``counted``."""

    SUCCESS = "success"
    COLLISION = "collision"
    TIMEOUT = "timeout"
    OFF_ROAD = "off_road"
    COUNTED = "counted"
    ERROR = "error"


@dataclass(frozen=True, slots=True)
class Collision:
    """A true overlap of two footprints."""

    time: float  # When the footprints first overlapped [s]
    striker: str
    struck: str
    pair: str  # ``CAV-CAV``, ``CAV-HDV``, ``HDV-HDV``, ``CAV-block`` or ``HDV-block``


@dataclass(frozen=True, slots=True)
class FlowArrival:
    """A vehicle of a flow that wanted to come in."""

    id: str
    kind: Kind
    time: float  # When it wanted to [s]


@dataclass(frozen=True, slots=True)
class FlowLog:
    """What is known of a flow besides its tracks."""

    begins: float  # When the window begins, which ends with the episode [s]
    step: float  # Simulation step [s]; the road may be empty for a while
    wanted: tuple[FlowArrival, ...]  # All who wanted to come in, also those who are still waiting outside
    collisions: tuple[Collision, ...]  # In the warm-up, too


@dataclass(frozen=True, slots=True)
class Outcome:
    """The one end of an episode."""

    ending: Ending
    time: float  # Simulated time at the end [s]
    arrivals: dict[str, float]  # Time of each CAV that arrived, and of each vehicle of a flow [s], by id
    collision: Collision | None = None
    bystander_collisions: tuple[Collision, ...] = ()
    off_road: tuple[str, ...] = ()
    message: str = ""  # What went wrong, for ``error``
    flow: FlowLog | None = None  # None for an episode, whose record does not name it

    @property
    def failed(self) -> tuple[str, ...]:
        """The vehicles of the collision, or those that left the road."""
        return self.off_road if self.collision is None else (self.collision.striker, self.collision.struck)


@dataclass(frozen=True, slots=True)
class Pet:
    """The post-encroachment time of one pair of vehicles."""

    first: str
    second: str
    kind: str  # Kind of the conflict, for instance ``crossing``
    value: float  # Time between the first leaving and the second entering [s]


@dataclass(frozen=True, slots=True)
class TravelScore:
    """How one vehicle travelled."""

    id: str
    velocity: float  # Mean travel velocity [m/s]
    time: float  # Travel time [s]
    delay: float | None  # Travel time beyond that of free flow [s], or None where the metric has no such notion


@dataclass(frozen=True, slots=True)
class NamedNumber:
    """A number that a metric measures besides; a column of its own in the tables."""

    name: str  # Name of the column, for instance ``waiting_time``
    value: float | None  # None where it is not defined, which is not zero
    unit: str = ""  # Its unit, for instance ``s``; empty without one
    # Whether a higher or a lower number is better; None where neither is.
    better: Literal["higher", "lower"] | None = None
    shown: bool = False  # Whether its mean is a column on the screen and in Markdown, too


@dataclass(frozen=True, slots=True)
class Score:
    """The measured quality of one episode."""

    success: bool | None  # None for a flow, which neither succeeds nor fails
    pets: tuple[Pet, ...] = ()
    travels: tuple[TravelScore, ...] = ()
    numbers: tuple[NamedNumber, ...] = ()
    # Those of the metric that gave it, as JSON by key; filled in by what calls the metric.
    settings: dict[str, str] = field(default_factory=dict)
    clean: bool | None = None  # Whether it is a success without a near miss; None where the metric does not say


@dataclass(frozen=True, slots=True)
class Participant:
    """A vehicle that took part in an episode."""

    id: str
    kind: str  # ``CAV`` or ``HDV``
    route: str
    arrived: float | None  # Time of arrival [s], or None
    style: str = ""  # Style of a human driver, where drivers have one; how a CAV misbehaves, if it does


@dataclass(frozen=True, slots=True)
class EpisodeRecord:
    """The result of one episode; free of anything that depends on the machine or its clock."""

    scenario: str
    method: str
    variant: str  # Name of the CDA variant, for instance ``full`` or ``no_negotiation/own_view``
    reasoner: str  # Who reasoned: ``rules`` or the name of a model
    seed: int
    outcome: Outcome
    scores: dict[str, Score]  # Its score by the name of the metric; none for ``error``
    participants: tuple[Participant, ...]
    decisions: int
    counts: dict[str, int | float]
    memory: str = ""
