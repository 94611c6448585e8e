"""The CDA level of a run (SAE J3216): which of the four sharing and deciding sub-modules are there."""

from dataclasses import dataclass
from typing import Literal

from codriving.errors import ConfigError

OwnOrder = Literal["own_view", "same_rule", "independent"]


@dataclass(frozen=True, slots=True)
class CdaLevel:
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
        missing = [
            name
            for name in ("state_sharing", "intent_sharing", "negotiation", "safety_check")
            if not getattr(self, name)
        ]
        name = "_".join(["no", *missing]) if missing else "full"
        if not self.negotiation and self.intent_sharing:
            name += f"/{self.own_order}"
        return f"{name}/binding" if self.binding else name
