"""How a request is tried: no more at once than a server takes, retried where that helps, each within its deadline."""

import asyncio
import random
from collections import deque
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass
from typing import TypeVar

from codriving.llm.faults import CallError, FaultKind


class ConcurrencyLimit:
    """Lets a number of requests through at once; halves it on 429 and lets it grow back by one a round of answers.

    After a time-out it grows back a sixteenth as fast: a server that works off one request after the other says nothing
    else, and each time-out is an answer lost. Used on one event loop, so it needs no lock.
    """

    def __init__(self, limit: int) -> None:
        self._most = limit
        self._limit = float(limit)
        self._inside = 0
        self._waiting: deque[asyncio.Future[None]] = deque()
        self._shrunk = 0
        self._pace = 1.0  # Answers that count as one

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

    def shrink(self, ticket: int, pace: float = 1.0) -> None:
        """Halve the number, once for all the requests that were under way together."""
        if ticket == self._shrunk:
            self._shrunk += 1
            self._pace = max(pace, self._pace)
            self._limit = max(1.0, self._limit / 2)

    def grow(self) -> None:
        """Note an answer: after as many as may be under way, one more may be."""
        self._limit = min(float(self._most), self._limit + 1 / (self._limit * self._pace))
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


Result = TypeVar("Result")
Sleep = Callable[[float], Awaitable[None]]

_FIRST = 1.0  # Wait after the first attempt, before jitter; it doubles with every further one [s]

_LONGEST = 30.0  # Longest wait of our own choice [s]

SLOWLY = 16.0  # After a time-out so many answers count as one, for the number of requests at once

PATIENCE = 120.0  # A server that asks for a longer wait than this is given up [s]


@dataclass(frozen=True, slots=True)
class Retry:
    """A retry that is about to be made."""

    model: str
    attempt: int
    attempts: int
    wait: float  # How long until the next one [s]
    reason: str

    def __str__(self) -> str:
        return f"{self.model} {self.reason}; attempt {self.attempt + 1} of {self.attempts} in {self.wait:.0f} s"


@dataclass(frozen=True)
class Retries:
    """How a request is tried again: only after what may pass, a bounded number of times, each visible."""

    model: str
    attempts: int
    deadline: float  # How long one attempt may take, from sending to the last byte [s]
    notify: Callable[[Retry], None]
    sleep: Sleep = asyncio.sleep
    jitter: Callable[[], float] = random.Random().random

    async def run(
        self, attempt: Callable[[], Awaitable[Result]], may_pass: Callable[[CallError], bool]
    ) -> tuple[Result, int]:
        """Try until it works, fails for good, or the attempts are used up."""
        made = 0
        while True:
            made += 1
            try:
                return await attempt(), made
            except CallError as fault:
                fault.attempts = made
                if made == self.attempts or not may_pass(fault) or (fault.retry_after or 0.0) > PATIENCE:
                    raise
                wait, reason = self._wait(made, fault.retry_after), str(fault)
            self.notify(Retry(self.model, made, self.attempts, wait, reason))
            await self.sleep(wait)

    async def within_deadline(self, attempt: Awaitable[Result]) -> Result:
        """Wait for one attempt and no longer than the deadline.

        A server that sends a byte now and then never makes a read time out; only this ends it.
        """
        with suppress(TimeoutError):
            async with asyncio.timeout(self.deadline):
                return await attempt
        raise CallError(FaultKind.TIMEOUT, f"{self.deadline:g} s")

    def _wait(self, made: int, retry_after: float | None) -> float:
        """Exponential with jitter over its upper half; never sooner than the server asks."""
        own = min(_LONGEST, _FIRST * 2.0 ** (made - 1)) * (0.5 + 0.5 * self.jitter())
        return own if retry_after is None else retry_after + 0.1 * own
