"""The world at one moment, as it is handed to a method."""

from collections.abc import Mapping
from dataclasses import dataclass

from codriving.datatypes.action import Action
from codriving.datatypes.vehicle import Intent, Kind, VehicleState


@dataclass(frozen=True, slots=True)
class WorldState:
    """All vehicles on the road, and what the CAVs among them intend.

    Human drivers have no entry in ``intents``: their minds cannot be read.
    """

    time: float  # Simulated time [s]
    step: int
    vehicles: tuple[VehicleState, ...]
    intents: Mapping[str, Intent]
    available: Mapping[str, tuple[Action, ...]]

    @property
    def cavs(self) -> tuple[VehicleState, ...]:
        """The connected automated vehicles on the road."""
        return tuple(v for v in self.vehicles if v.kind is Kind.CAV)

    @property
    def hdvs(self) -> tuple[VehicleState, ...]:
        """The human-driven vehicles on the road."""
        return tuple(v for v in self.vehicles if v.kind is Kind.HDV)
