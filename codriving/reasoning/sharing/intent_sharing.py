"""Intent sharing, SAE J3216 class B: the routes and target speeds that CAVs tell one another (Section III-C.2)."""

from collections.abc import Mapping
from typing import Protocol

from codriving.datatypes.vehicle import Intent
from codriving.datatypes.world import WorldState


class IntentSharing(Protocol):
    """Decides which intents are known, and whether conflicts can be seen at all."""

    finds_conflicts: bool

    def intents(self, world: WorldState) -> Mapping[str, Intent]:
        """Return the intents that every CAV knows of the others."""
        ...


class SharedIntents:
    """Every CAV tells its route, target lane and target speed."""

    finds_conflicts = True

    def intents(self, world: WorldState) -> Mapping[str, Intent]:
        """Return the intents of all CAVs; human drivers share none."""
        return world.intents


class HiddenIntents:
    """Without intent sharing, no conflicts between others and oneself can be detected (paper Section IV-B)."""

    finds_conflicts = False

    def intents(self, world: WorldState) -> Mapping[str, Intent]:
        """Return nothing."""
        return {}


class GuessedIntents:
    """Nobody tells anything; the map says where everybody may go, and conflicts are found with all of these ways."""

    finds_conflicts = True

    def intents(self, world: WorldState) -> Mapping[str, Intent]:
        """Return nothing."""
        return {}
