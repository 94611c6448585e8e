"""What an episode is judged by; undefined is not zero."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Pet:
    """The post-encroachment time of one pair of vehicles.

    Attributes:
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
    """The measured quality of one episode."""

    success: bool
    pets: tuple[Pet, ...]
    travels: tuple[TravelScore, ...]
