"""How many requests may be under way: fewer after a server has said that they are too many."""

import asyncio
from collections import deque
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager


class Gate:
    """Lets a number of requests through at once; halves it on 429 and lets it grow back by one a round of answers.

    Used on one event loop, so it needs no lock.
    """

    def __init__(self, limit: int) -> None:
        self._most = limit
        self._limit = float(limit)
        self._inside = 0
        self._waiting: deque[asyncio.Future[None]] = deque()
        self._shrunk = 0

    @property
    def limit(self) -> int:
        """How many requests may be under way now."""
        return int(self._limit)

    @asynccontextmanager
    async def slot(self) -> AsyncIterator[int]:
        """Wait for a place and hold it; yields a ticket for ``shrink``."""
        await self._enter()
        try:
            yield self._shrunk
        finally:
            self._inside -= 1
            self._wake()

    def shrink(self, ticket: int) -> None:
        """Halve the number, once for all the requests that were under way together.

        Args:
            ticket: What ``slot`` gave to the request that was turned away.
        """
        if ticket == self._shrunk:
            self._shrunk += 1
            self._limit = max(1.0, self._limit / 2)

    def grow(self) -> None:
        """Note an answer: after as many as may be under way, one more may be."""
        self._limit = min(float(self._most), self._limit + 1 / self._limit)
        self._wake()

    async def _enter(self) -> None:
        if self._inside < self.limit and not self._waiting:
            self._inside += 1
            return
        place = asyncio.get_running_loop().create_future()
        self._waiting.append(place)
        try:
            await place
        except asyncio.CancelledError:
            if place.done() and not place.cancelled():
                self._inside -= 1
            elif place in self._waiting:
                self._waiting.remove(place)
            self._wake()
            raise

    def _wake(self) -> None:
        while self._waiting and self._inside < self.limit:
            place = self._waiting.popleft()
            if not place.done():
                self._inside += 1
                place.set_result(None)
