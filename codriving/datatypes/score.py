"""What an episode is judged by; undefined is not zero."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Pet:
    """The post-encroachment time of one pair of vehicles.

    Attributes:
        first: Id of the vehicle that left the conflict area.
        second: Id of the vehicle that entered it afterwards.
        kind: Kind of the conflict, for instance ``crossing``.
        value: Time between the first leaving and the second entering [s].
    """

    first: str
    second: str
    kind: str
    value: float


@dataclass(frozen=True, slots=True)
class TravelScore:
    """How one vehicle travelled.

    Attributes:
        id: Vehicle id.
        velocity: Mean travel velocity [m/s].
        time: Travel time [s].
        delay: Travel time beyond that of free flow [s], or None where the metric has no such notion.
    """

    id: str
    velocity: float
    time: float
    delay: float | None


@dataclass(frozen=True, slots=True)
class Score:
    """The measured quality of one episode.

    Attributes:
        success: Whether every CAV arrived safely and in time.
        pets: Every pair that met; empty where nobody did.
        travels: Every vehicle that the metric counts.
    """

    success: bool
    pets: tuple[Pet, ...]
    travels: tuple[TravelScore, ...]
