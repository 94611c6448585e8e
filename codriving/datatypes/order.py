"""Who goes first, and why."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Precedence:
    """One vehicle passes a conflict zone before another.

    Attributes:
        first: Id of the vehicle that goes first.
        second: Id of the vehicle that waits for it.
        reason: Why, in words that a person or a model can read.
    """

    first: str
    second: str
    reason: str


@dataclass(frozen=True, slots=True)
class PassingOrder:
    """The answer of a coordinator: an order without cycles.

    Attributes:
        sequence: All vehicles that are in a conflict, first to last.
        precedences: The pairs that were asked about, each with its reason.
        binding: Whether the order is an instruction (CDA class D) or advice (class C).
    """

    sequence: tuple[str, ...]
    precedences: tuple[Precedence, ...]
    binding: bool = False

    def first_of(self, one: str, other: str) -> str | None:
        """Return which of two vehicles goes first, or None if they were not asked about."""
        for p in self.precedences:
            if (p.first == one and p.second == other) or (p.first == other and p.second == one):
                return p.first
        return None
