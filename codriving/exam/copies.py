"""Copies of a world and what drives in it: written down once, and read for each copy."""

import pickle
from collections.abc import Iterable
from io import BytesIO
from typing import Any


class Copies:
    """What was written down at one moment; copies share some parts with it.

    Args:
        what: What is copied.
        shared: Parts that are not, as the road.
    """

    def __init__(self, what: object, shared: Iterable[object]) -> None:
        self._shared = {id(part): part for part in shared}
        writer = _SharingPickler(out := BytesIO(), pickle.HIGHEST_PROTOCOL)
        writer.shared = self._shared
        writer.dump(what)
        self._written = out.getvalue()

    def another(self) -> Any:  # noqa: ANN401 - of the type of what was written down
        """Return a copy."""
        reader = _SharingUnpickler(BytesIO(self._written))
        reader.shared = self._shared
        return reader.load()


class _SharingPickler(pickle.Pickler):
    """Writes down all but the shared parts, which it names."""

    shared: dict[int, object]

    def persistent_id(self, part: object) -> int | None:
        return id(part) if id(part) in self.shared else None


class _SharingUnpickler(pickle.Unpickler):
    """Puts the shared parts where they were named."""

    shared: dict[int, object]

    def persistent_load(self, name: int) -> object:
        return self.shared[name]
