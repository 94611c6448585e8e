"""Who goes first, and why."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Precedence:
    """One vehicle passes a conflict zone before another."""

    first: str
    second: str
    reason: str


@dataclass(frozen=True, slots=True)
class PassingOrder:
    """The answer of a coordinator: an order without cycles."""

    sequence: tuple[str, ...]
    precedences: tuple[Precedence, ...]
    binding: bool = False

    def first_of(self, one: str, other: str) -> str | None:
        """Return which of two vehicles goes first, or None if they were not asked about."""
        for p in self.precedences:
            if (p.first == one and p.second == other) or (p.first == other and p.second == one):
                return p.first
        return None
