"""What the rows of a comparison differ in, in the words of its tables."""

from dataclasses import dataclass

REFERENCE = "codriving"  # The method that all others are compared with


@dataclass(frozen=True)
class Subject:
    """What is compared with what."""

    rows: str = "methods"
    row: str = "method"
    reference: str = REFERENCE
    notes: tuple[str, ...] = ()  # What varies and what is shared


METHODS = Subject()
