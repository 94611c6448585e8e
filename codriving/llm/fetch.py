"""One request until the server has replied: in the best form it takes, retried where that helps, and paid for."""

import time
from collections.abc import Callable
from dataclasses import replace

from codriving.llm.faults import CallError, Kind
from codriving.llm.forms import Forms
from codriving.llm.gate import Gate
from codriving.llm.key import Key
from codriving.llm.reply import TOO_LONG, UNREADABLE, Reply, Request
from codriving.llm.retrying import Retries, Retry, Sleep
from codriving.llm.send import Sender
from codriving.llm.settings import Purse, Settings

FILTERED = "content_filter"

STOOD_FOR = {Kind.TOO_LONG: TOO_LONG, Kind.FILTERED: FILTERED, Kind.UNREADABLE: UNREADABLE}
"""Failures that are answers of a kind: the question is what has to change. With the finish reason they are given."""


class Fetcher:
    """Fetches replies from the server of one model; used on the one loop alone.

    Args:
        price: Cost of so many prompt and completion tokens [USD]; None where no price is known.
    """

    def __init__(
        self,
        settings: Settings,
        price: Callable[[int, int], float | None],
        spending: Purse,
        sender: Sender,
        sleep: Sleep,
        forms: Forms,
        notify: Callable[[Retry], None],
    ) -> None:
        self.key = Key(settings.api_key_env, settings.api_base)
        self.worked = False
        self._price, self._spending, self._sender, self._forms = price, spending, sender, forms
        self._deadline = settings.deadline
        self._gate = Gate(settings.max_concurrency)
        self._retries = Retries(settings.model, settings.attempts, settings.deadline, notify, sleep)

    async def fetch(self, request: Request) -> Reply:
        """Ask the server.

        Raises:
            CallError: If there is no reply, retries included.
            ModelError: If the key is missing.
        """
        await self._sender.load()
        begun, sent = time.perf_counter(), 0
        while True:
            form = self._forms.best(request.model, request.api_base) if request.schema else "text"
            made = 0

            async def attempt(form: str = form) -> Reply:
                nonlocal made
                made += 1
                return await self._attempt(request, form)

            try:
                reply = await self._retries.run(attempt, self._may_pass)
            except CallError as fault:
                sent += made
                fault.attempts = sent
                if fault.kind is Kind.FORM and self._forms.step_down(request.model, request.api_base, form):
                    continue
                if fault.kind not in STOOD_FOR:
                    raise
                reply = Reply("", STOOD_FOR[fault.kind], refusal=fault.detail, form=form)
            else:
                sent += made
            break
        self.worked = True
        cost = self._price(reply.prompt_tokens, reply.completion_tokens)
        self._spending.add(reply.prompt_tokens, reply.completion_tokens, cost)
        seconds = round(time.perf_counter() - begun, 3)
        return replace(reply, form=form, cost=cost, seconds=seconds, attempts=sent)

    async def _attempt(self, request: Request, form: str) -> Reply:
        async with self._gate.slot() as ticket:
            sending = self._sender.send(request, form, self.key.read(), self._deadline)
            try:
                reply = await self._retries.within_deadline(sending)
            except CallError as fault:
                if fault.kind is Kind.RATE:
                    self._gate.shrink(ticket)
                raise
            self._gate.grow()
            return reply

    def _may_pass(self, fault: CallError) -> bool:
        # Before anything has worked, an address where nobody listens is a wrong address.
        return fault.kind.passes and (self.worked or fault.kind is not Kind.UNREACHABLE)
