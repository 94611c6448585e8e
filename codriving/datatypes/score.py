"""What an episode is judged by; undefined is not zero."""

from dataclasses import dataclass, field
from typing import Literal


@dataclass(frozen=True, slots=True)
class Pet:
    """The post-encroachment time of one pair of vehicles."""

    first: str
    second: str
    kind: str  # Kind of the conflict, for instance ``crossing``
    value: float  # Time between the first leaving and the second entering [s]


@dataclass(frozen=True, slots=True)
class TravelScore:
    """How one vehicle travelled.

    Attributes:
        delay: Travel time beyond that of free flow [s], or None where the metric has no such notion.
    """

    id: str
    velocity: float  # Mean travel velocity [m/s]
    time: float  # Travel time [s]
    delay: float | None


@dataclass(frozen=True, slots=True)
class NamedNumber:
    """A number that a metric measures besides; a column of its own in the tables.

    Attributes:
        name: Name of the column, for instance ``waiting_time``.
        value: None where it is not defined, which is not zero.
        unit: Its unit, for instance ``s``; empty without one.
        better: Whether a higher or a lower number is better; None where neither is.
        shown: Whether its mean is a column on the screen and in Markdown, too.
    """

    name: str
    value: float | None
    unit: str = ""
    better: Literal["higher", "lower"] | None = None
    shown: bool = False


@dataclass(frozen=True, slots=True)
class Score:
    """The measured quality of one episode.

    Attributes:
        settings: Those of the metric that gave it, as JSON by key; filled in by what calls the metric.
    """

    success: bool
    pets: tuple[Pet, ...] = ()
    travels: tuple[TravelScore, ...] = ()
    numbers: tuple[NamedNumber, ...] = ()
    settings: dict[str, str] = field(default_factory=dict)
