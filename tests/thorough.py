"""How much of the same kind is tried: all of it in ``make check-all``, some of it in ``make test``."""

import os
from collections.abc import Sequence
from typing import TypeVar

T = TypeVar("T")

THOROUGH = bool(os.environ.get("DRAWN"))


def some(number: int, everything: Sequence[T]) -> Sequence[T]:
    """The first ones; all of them where tests are thorough."""
    return everything if THOROUGH else everything[:number]
