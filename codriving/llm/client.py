"""A language model that answers questions, all of a step at once."""

import asyncio
import json
from collections.abc import Callable, Sequence
from typing import Any
from weakref import WeakValueDictionary

from codriving.llm.blame import must_be_mended, unavailable, unusable
from codriving.llm.conversation import converse
from codriving.llm.faults import CallError
from codriving.llm.fetch import STOOD_FOR, Fetcher
from codriving.llm.forms import KNOWN, Forms, schema_of
from codriving.llm.loop import loop
from codriving.llm.question import Answer, Message, Question
from codriving.llm.reply import Reply, Request
from codriving.llm.retrying import Retry, Sleep
from codriving.llm.send import LiteLLMSender, Sender
from codriving.llm.settings import Cache, Purse, Settings

_GREETING = (
    Message("system", "You check that a connection works."),
    Message("user", "Answer with the one word: yes"),
)


class ModelChat:
    """A language model behind one client for the whole process; may be asked from any thread.

    Args:
        price: Cost of so many prompt and completion tokens [USD]; None where no price is known.
        cache: Keeps replies; None keeps none.
    """

    def __init__(
        self,
        settings: Settings,
        price: Callable[[int, int], float | None],
        spending: Purse,
        cache: Cache | None = None,
        sender: Sender | None = None,
        sleep: Sleep = asyncio.sleep,
        forms: Forms = KNOWN,
    ) -> None:
        self.name = settings.model
        self.on_retry: Callable[[Retry], None] = lambda retry: None
        self.settings, self.spending = settings, spending
        self._cache = cache
        self._fetcher = Fetcher(
            settings, price, spending, sender or LiteLLMSender(), sleep, forms, lambda retry: self.on_retry(retry)
        )
        self._under_way: WeakValueDictionary[str, asyncio.Lock] = WeakValueDictionary()

    def ask(self, questions: Sequence[Question]) -> list[Answer]:
        """Ask several questions at once and wait for all answers.

        Raises:
            ModelError: If nothing has worked yet and the user has to mend it: no key, no server, no such model.
            ModelUnavailableError: If the server cannot be reached, refuses or is too slow, retries included.
            SpendingLimitError: If the tokens or the money that may be spent are used up.
        """
        if not questions:
            return []
        self.spending.check()
        return loop().run(self._ask_all(questions))

    def preflight(self) -> None:
        """Make one short call before the first episode, unless one has worked already or the cache alone answers.

        Raises:
            ModelError: If the model cannot be used; the message says what to set.
            SpendingLimitError: If the tokens or the money that may be spent are used up.
        """
        if self.settings.replay or self._fetcher.worked:
            return
        self.spending.check()
        self._fetcher.key.read()
        loop().run(self._greet())

    async def _greet(self) -> None:
        try:
            reply = await self._fetcher.fetch(self._request(_GREETING, None))
        except CallError as fault:
            failed = fault
        else:
            if reply.finish_reason not in STOOD_FOR.values():
                return
            kind = next(kind for kind, reason in STOOD_FOR.items() if reason == reply.finish_reason)
            failed = CallError(kind, reply.refusal)
        self._fetcher.worked = False
        raise self._unusable(failed)

    async def _ask_all(self, questions: Sequence[Question]) -> list[Answer]:
        # All are waited for even if one fails: the others are paid for and belong into the cache.
        answers = await asyncio.gather(
            *(converse(question, self._answer) for question in questions), return_exceptions=True
        )
        for answer in answers:
            if isinstance(answer, BaseException):
                raise answer
        return [answer for answer in answers if isinstance(answer, Answer)]

    async def _answer(self, messages: tuple[Message, ...], question: Question) -> tuple[Reply, bool]:
        """Reply to a conversation from the cache or by asking, and say which."""
        request = self._request(messages, schema_of(question.schema))
        try:
            if self._cache is not None:
                return await self._cached(self._cache, request)
            return await self._fetcher.fetch(request), False
        except CallError as fault:
            failed = fault
        if must_be_mended(failed) and not self._fetcher.worked:
            raise self._unusable(failed)
        raise unavailable(failed, self.name, self.settings.api_base)

    async def _cached(self, cache: Cache, request: Request) -> tuple[Reply, bool]:
        """Ask only what is not there, and the same thing only once even if it is asked twice at the same time."""
        wanted = request.as_dict()
        name = json.dumps(wanted, sort_keys=True)
        lock = self._under_way.setdefault(name, asyncio.Lock())
        async with lock:
            stored = cache.find(wanted)
            if stored is not None:
                return Reply.from_dict(stored), True
            reply = await self._fetcher.fetch(request)
            # Another process may have been quicker; a replay will find its reply, so this run goes by it, too.
            return Reply.from_dict(cache.keep(wanted, reply.as_dict())), False

    def _request(self, messages: tuple[Message, ...], schema: dict[str, Any] | None) -> Request:
        s = self.settings
        return Request(s.model, s.api_base, messages, s.temperature, s.max_tokens, schema)

    def _unusable(self, fault: CallError) -> Exception:
        return unusable(fault, self.name, self.settings.api_base, self.settings.api_key_env)
