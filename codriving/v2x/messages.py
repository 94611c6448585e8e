"""What CAVs send one another, named after the messages of the standards."""

from dataclasses import dataclass

from codriving.datatypes import Action, Intent, VehicleState


@dataclass(frozen=True, slots=True)
class V2xMessage:
    """What one CAV tells all that can hear it."""

    sender: str
    time: float  # When it was made [s]
    validity: float  # How long it may be used after that [s]
    size: int  # [bytes]


@dataclass(frozen=True, slots=True)
class CooperativeAwareness(V2xMessage):
    """The sender's own state: CAM (ETSI EN 302 637-2), or BSM (SAE J2735)."""

    state: VehicleState


@dataclass(frozen=True, slots=True)
class PerceivedObject:
    """A vehicle that the sender's own sensors see."""

    state: VehicleState
    signal: str  # The turn that it signals, ``left`` or ``right``; empty for none


@dataclass(frozen=True, slots=True)
class CollectivePerception(V2xMessage):
    """The vehicles without a radio that the sender sees: CPM (ETSI TS 103 324)."""

    objects: tuple[PerceivedObject, ...]


@dataclass(frozen=True, slots=True)
class RouteSharing(V2xMessage):
    """Where a human driver means to go, told by a device that does not drive."""

    route: str


@dataclass(frozen=True, slots=True)
class ManoeuvreCoordination(V2xMessage):
    """What the sender means to do: MCM (ETSI TR 103 578)."""

    intent: Intent
    available: tuple[Action, ...]  # What it can do at all, lane changes included
