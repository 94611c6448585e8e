"""The one owner of retries: only what may pass, a bounded number of times, each visible."""

import asyncio
import random
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import TypeVar

from tenacity import AsyncRetrying, RetryCallState, retry_if_exception, stop_after_attempt

from codriving.llm.faults import CallError, Kind

Result = TypeVar("Result")
Sleep = Callable[[float], Awaitable[None]]

_FIRST = 1.0
"""Wait after the first attempt, before jitter; it doubles with every further one [s]."""

_LONGEST = 30.0
"""Longest wait of our own choice [s]."""

PATIENCE = 120.0
"""A server that asks for a longer wait than this is given up [s]."""


@dataclass(frozen=True, slots=True)
class Retry:
    """A retry that is about to be made.

    Attributes:
        wait: How long until the next one [s].
    """

    model: str
    attempt: int
    attempts: int
    wait: float
    reason: str

    def __str__(self) -> str:
        return f"{self.model} {self.reason}; attempt {self.attempt + 1} of {self.attempts} in {self.wait:.0f} s"


@dataclass(frozen=True)
class Retries:
    """How a request is tried again.

    Attributes:
        deadline: How long one attempt may take, from sending to the last byte [s].
    """

    model: str
    attempts: int
    deadline: float
    notify: Callable[[Retry], None]
    sleep: Sleep = asyncio.sleep
    jitter: Callable[[], float] = random.Random().random

    async def run(self, attempt: Callable[[], Awaitable[Result]], may_pass: Callable[[CallError], bool]) -> Result:
        """Try until it works, fails for good, or the attempts are used up.

        Raises:
            CallError: The last failure; its ``attempts`` says how many there were.
        """
        tried = AsyncRetrying(
            sleep=self.sleep,
            stop=stop_after_attempt(self.attempts),
            wait=self._wait,
            retry=retry_if_exception(
                lambda error: isinstance(error, CallError) and may_pass(error) and _bearable(error)
            ),
            before_sleep=self._tell,
            reraise=True,
        )
        made = 0

        async def once() -> Result:
            nonlocal made
            made += 1
            return await attempt()

        try:
            return await tried(once)
        except CallError as fault:
            fault.attempts = made
            raise

    async def within_deadline(self, attempt: Awaitable[Result]) -> Result:
        """Wait for one attempt and no longer than the deadline.

        A server that sends a byte now and then never makes a read time out; only this ends it.

        Raises:
            CallError: If it took too long, or failed by itself.
        """
        try:
            async with asyncio.timeout(self.deadline):
                return await attempt
        except TimeoutError:
            pass
        raise CallError(Kind.TIMEOUT, f"{self.deadline:g} s")

    def _wait(self, state: RetryCallState) -> float:
        """Exponential with jitter over its upper half; never sooner than the server asks."""
        own = min(_LONGEST, _FIRST * 2.0 ** (state.attempt_number - 1)) * (0.5 + 0.5 * self.jitter())
        fault = _fault(state)
        if fault is None or fault.retry_after is None:
            return own
        return fault.retry_after + 0.1 * own

    def _tell(self, state: RetryCallState) -> None:
        reason = str(_fault(state))
        self.notify(Retry(self.model, state.attempt_number, self.attempts, state.upcoming_sleep, reason))


def _bearable(fault: CallError) -> bool:
    return fault.retry_after is None or fault.retry_after <= PATIENCE


def _fault(state: RetryCallState) -> CallError | None:
    error = state.outcome.exception() if state.outcome else None
    return error if isinstance(error, CallError) else None
