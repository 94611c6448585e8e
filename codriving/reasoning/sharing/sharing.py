"""The CDA level of a run (SAE J3216), and what each CAV is told of the others (Section III-C.1 and 2)."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from codriving.datatypes import Cooperation, DrivingModel, Intent, TrackedVehicle, WorldState
from codriving.errors import ConfigError
from codriving.geometry import TRUE

USUAL_LENGTH = TRUE.length  # Length that is assumed of a vehicle which is only sensed [m]

Detections = dict[str, tuple[TrackedVehicle, ...]]  # Vehicles that each CAV knows of, by id of the CAV


class StateSharing(ABC):
    """Turns the world into what each CAV knows of it."""

    @abstractmethod
    def detections(self, world: WorldState, model: DrivingModel) -> Detections:
        """Return the vehicles that each CAV knows of."""


class SharedStates(StateSharing):
    """CAVs share their own states, and those of the human drivers that any of them perceives."""

    def detections(self, world: WorldState, model: DrivingModel) -> Detections:
        """Return the same full states for all: every CAV, and every HDV that at least one CAV senses."""
        cavs = world.cavs
        seen = [h for h in world.hdvs if world.known_to_cavs(h, model.detection_range)]
        known = tuple(
            TrackedVehicle(v.id, v.kind, v.x, v.y, v.speed, v.heading, v.acceleration, v.lane, v.length)
            for v in sorted((*cavs, *seen), key=lambda v: v.id)
        )
        return {cav.id: tuple(v for v in known if v.id != cav.id) for cav in cavs}


@dataclass(frozen=True, slots=True)
class SensedStates(StateSharing):
    """Without state sharing: position and speed of the vehicles that a CAV senses (paper Section IV-B).

    Which lane they are on stays open, since a simulator knows by the route on which of two lanes, one above the other,
    a vehicle is; and so does who drives.
    """

    headings: bool = False  # Whether headings are sensed as well

    def detections(self, world: WorldState, model: DrivingModel) -> Detections:
        """Return what each CAV's own sensors tell."""
        return {
            cav.id: tuple(
                TrackedVehicle(
                    v.id, None, v.x, v.y, v.speed, v.heading if self.headings else None, None, None, USUAL_LENGTH
                )
                for v in world.vehicles
                if v.id != cav.id and world.senses(cav, v, model.detection_range)
            )
            for cav in world.cavs
        }


@dataclass(frozen=True, slots=True)
class IntentSharing:
    """Which intents are known, and whether conflicts can be found at all."""

    shared: bool  # Whether every CAV tells its route, target lane and target speed; human drivers never do
    finds_conflicts: bool  # Whether conflicts are found, with the routes that are shared or that the map allows

    def intents(self, world: WorldState) -> Mapping[str, Intent]:
        """Return the intents that every CAV knows of the others."""
        return world.intents if self.shared else {}


SHARED_INTENTS = IntentSharing(shared=True, finds_conflicts=True)

# Without intent sharing, no conflicts between others and oneself can be detected (paper Section IV-B).
HIDDEN_INTENTS = IntentSharing(shared=False, finds_conflicts=False)

# Nothing is shared, and conflicts are found with all ways that the map allows.
GUESSED_INTENTS = IntentSharing(shared=False, finds_conflicts=True)

OwnOrder = Literal["own_view", "same_rule", "independent"]


@dataclass(frozen=True, slots=True)
class CdaLevel(Cooperation):
    """Toggles of the reasoning module.

    Raises:
        ConfigError: If the order is to bind without being negotiated.
    """

    state_sharing: bool
    intent_sharing: bool
    negotiation: bool
    safety_check: bool
    binding: bool
    own_order: OwnOrder

    def __post_init__(self) -> None:
        if self.binding and not self.negotiation:
            raise ConfigError("cda.binding=true needs cda.negotiation=true: only a negotiated order can bind")
        if self.own_order not in ("own_view", "same_rule", "independent"):
            raise ConfigError(f"cda.own_order must be own_view, same_rule or independent, got {self.own_order!r}")

    @property
    def variant(self) -> str:
        """Name of the variant for tables, for instance ``full`` or ``no_negotiation/own_view``."""
        parts = ("state_sharing", "intent_sharing", "negotiation", "safety_check")
        missing = [part for part in parts if not getattr(self, part)]
        name = "_".join(["no", *missing]) if missing else "full"
        if not self.negotiation and self.intent_sharing:
            name += f"/{self.own_order}"
        return f"{name}/binding" if self.binding else name
