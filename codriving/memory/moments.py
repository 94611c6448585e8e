"""One CAV's way through an episode, as it is looked back on: what was so when it decided, step by step."""

from collections.abc import Mapping
from dataclasses import dataclass

from codriving.datatypes.action import Action
from codriving.datatypes.conflict import Conflict
from codriving.datatypes.vehicle import VehicleState


@dataclass(frozen=True, slots=True)
class Moment:
    """The world when one CAV decided, and what it decided.

    Attributes:
        lead_gap: Free distance to whoever drives ahead on its lane [m]; None if nobody does.
        action: What it decided; None at the end of the episode.
    """

    ego: VehicleState
    others: Mapping[str, VehicleState]
    conflicts: tuple[Conflict, ...]
    lead_gap: float | None
    action: Action | None
    could_go: bool


@dataclass(frozen=True, slots=True)
class Crash:
    """A collision, seen from one of the two.

    Attributes:
        time: When it was, counted from the first moment [s].
    """

    time: float
    other: str
    striker: bool


@dataclass(frozen=True, slots=True)
class Way:
    """The moments of one CAV, a decision step apart, until it arrived or the episode ended.

    Attributes:
        interval: Time between two of them [s].
        crash: The collision that it was in; None if in none.
    """

    moments: tuple[Moment, ...]
    interval: float
    crash: Crash | None = None
