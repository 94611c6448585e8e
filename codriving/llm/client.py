"""A language model that answers questions, all of a step at once: from the cache, or in the best form it takes."""

import asyncio
import json
import time
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import asdict, replace
from functools import partial
from typing import Any
from weakref import WeakValueDictionary

from codriving.llm.answers import judge
from codriving.llm.attempts import ConcurrencyLimit, Retries, Retry, Sleep
from codriving.llm.cache import AnswerCache
from codriving.llm.faults import CallError, FaultKind, unavailable, unusable
from codriving.llm.loop import loop
from codriving.llm.parsing import one_line
from codriving.llm.question import Answer, Call, Chat, Message, Question
from codriving.llm.request import KNOWN, TOO_LONG, UNREADABLE, ChatRequest, Forms, Reply, schema_of, worded
from codriving.llm.send import Sender
from codriving.llm.settings import ModelSettings, read_key
from codriving.llm.spending import Spending, cost_of

# Gives the reply to a conversation, and whether it came from the cache.
Fetch = Callable[[tuple[Message, ...], Question], Awaitable[tuple[Reply, bool]]]


async def converse(question: Question, fetch: Fetch) -> Answer:
    """Ask a question."""
    calls: list[Call] = []
    shortened = 0
    again: tuple[Message, ...] = ()
    while True:
        messages = question.messages + again
        reply, cached = await fetch(messages, question)
        read = judge(reply, question)
        call = Call(
            messages=worded(messages, reply.form, schema_of(question.schema)),
            text=reply.text or next(iter(reply.beside), ""),
            form=reply.form,
            prompt_tokens=reply.prompt_tokens,
            completion_tokens=reply.completion_tokens,
            cost=reply.cost,
            seconds=reply.seconds,
            attempts=reply.attempts,
            cached=cached,
            problem=read.problem,
        )
        calls.append(call)
        if reply.finish_reason == TOO_LONG:
            shorter = question.shorter()
            if shorter is None:
                return Answer(None, tuple(calls), read.problem, shortened)
            question, shortened = shorter, shortened + 1
        elif read.value is not None or again:
            return Answer(read.value, tuple(calls), read.problem, shortened, read.mended)
        else:
            # Some servers insist that user and assistant take turns.
            wish = "Answer again, with one JSON object of the form asked for."
            said = Message("assistant", one_line(reply.text, 2000) or "(no answer)")
            again = (said, Message("user", f"This answer cannot be used: {read.problem}. {wish}"))


_GREETING = (Message("system", "You check that a connection works."), Message("user", "Answer with the one word: yes"))

# Failures that are replies of a kind, by the finish reason that they are given: the question has to change.
_FINISH_REASONS = {FaultKind.TOO_LONG: TOO_LONG, FaultKind.FILTERED: "content_filter", FaultKind.UNREADABLE: UNREADABLE}

# Failures that no later episode would escape, if nothing has worked yet.
_FOR_GOOD = (FaultKind.KEY, FaultKind.MODEL, FaultKind.UNREACHABLE, FaultKind.REDIRECT)


class ModelChat(Chat):
    """A language model behind one client for the whole process; any thread may call it."""

    def __init__(
        self,
        settings: ModelSettings,
        cache: AnswerCache | None = None,
        spending: Spending | None = None,
        sender: Sender | None = None,
        sleep: Sleep = asyncio.sleep,
        forms: Forms = KNOWN,
    ) -> None:
        self.name, self.settings = settings.model, settings
        self.spending = spending or Spending(settings.max_cost, settings.max_tokens_total)
        self.on_retry: Callable[[Retry], None] = lambda retry: None
        self._cache, self._sender, self._forms = cache, sender or Sender(), forms
        self._worked = False
        self._limit = ConcurrencyLimit(settings.max_concurrency)
        limits = settings.attempts, settings.deadline
        self._retries = Retries(settings.model, *limits, lambda retry: self.on_retry(retry), sleep)
        self._under_way: WeakValueDictionary[str, asyncio.Lock] = WeakValueDictionary()

    def ask(self, questions: Sequence[Question]) -> list[Answer]:
        if not questions:
            return []
        self.spending.check()
        return loop().run(self._ask_all(questions))

    def preflight(self) -> None:
        """Make one short call before the first episode, unless one has worked already or the cache alone answers."""
        if self.settings.cache == "replay" or self._worked:
            return
        self.spending.check()
        self._key()
        loop().run(self._greet())

    async def _greet(self) -> None:
        try:
            reply = await self._fetch(self._request(_GREETING, None))
        except CallError as fault:
            failed = fault
        else:
            kinds = [kind for kind, reason in _FINISH_REASONS.items() if reason == reply.finish_reason]
            if not kinds:
                return
            failed = CallError(kinds[0], reply.refusal)
        self._worked = False
        raise unusable(failed, self.settings)

    async def _ask_all(self, questions: Sequence[Question]) -> list[Answer]:
        # All are waited for even if one fails: the others are paid for and belong into the cache.
        answering = (converse(question, self._answer) for question in questions)
        answers = await asyncio.gather(*answering, return_exceptions=True)
        for answer in answers:
            if isinstance(answer, BaseException):
                raise answer
        return [answer for answer in answers if isinstance(answer, Answer)]

    async def _answer(self, messages: tuple[Message, ...], question: Question) -> tuple[Reply, bool]:
        """Reply to a conversation from the cache or by asking, and say which."""
        request = self._request(messages, schema_of(question.schema))
        request = replace(request, max_tokens=request.max_tokens + question.more_tokens)
        try:
            if self._cache is not None:
                return await self._cached(self._cache, request)
            return await self._fetch(request), False
        except CallError as fault:
            failed = fault
        if failed.kind is FaultKind.QUOTA or (failed.kind in _FOR_GOOD and not self._worked):
            raise unusable(failed, self.settings)
        raise unavailable(failed, self.settings)

    async def _cached(self, cache: AnswerCache, request: ChatRequest) -> tuple[Reply, bool]:
        """Ask only what is not there, and the same thing only once even if it is asked twice at the same time."""
        wanted = asdict(request)
        lock = self._under_way.setdefault(json.dumps(wanted, sort_keys=True), asyncio.Lock())
        async with lock:
            stored = cache.find(wanted)
            if stored is not None:
                return Reply.from_dict(stored), True
            reply = await self._fetch(request)
            # Another process may have been quicker; a replay will find its reply, so this run goes by it, too.
            return Reply.from_dict(cache.keep(wanted, asdict(reply))), False

    async def _fetch(self, request: ChatRequest) -> Reply:
        """Ask the server in the strictest form that it takes, retry where that helps, and pay."""
        await self._sender.load()
        begun, sent = time.perf_counter(), 0
        while True:
            form = self._forms.best(request.model, request.api_base) if request.schema else "text"
            try:
                reply, made = await self._retries.run(partial(self._attempt, request, form), self._may_pass)
                sent += made
                break
            except CallError as fault:
                sent += fault.attempts
                fault.attempts = sent
                if fault.kind is FaultKind.FORM and self._forms.step_down(request.model, request.api_base, form):
                    continue
                if fault.kind not in _FINISH_REASONS:
                    raise
                reply = Reply("", _FINISH_REASONS[fault.kind], refusal=fault.detail)
                break
        self._worked = True
        prices = self.settings.input_cost_per_token, self.settings.output_cost_per_token
        cost = cost_of(self.name, reply.prompt_tokens, reply.completion_tokens, *prices)
        self.spending.add(reply.prompt_tokens, reply.completion_tokens, cost)
        return replace(reply, form=form, cost=cost, seconds=round(time.perf_counter() - begun, 3), attempts=sent)

    async def _attempt(self, request: ChatRequest, form: str) -> Reply:
        async with self._limit.slot() as ticket:
            sending = self._sender.send(request, form, self._key(), self.settings.deadline)
            try:
                reply = await self._retries.within_deadline(sending)
            except CallError as fault:
                if fault.kind is FaultKind.RATE:
                    self._limit.shrink(ticket)
                raise
            self._limit.grow()
            return reply

    def _may_pass(self, fault: CallError) -> bool:
        # Before anything has worked, an address at which no server listens is a wrong address.
        return fault.kind.passes and (self._worked or fault.kind is not FaultKind.UNREACHABLE)

    def _request(self, messages: tuple[Message, ...], schema: dict[str, Any] | None) -> ChatRequest:
        s = self.settings
        return ChatRequest(s.model, s.api_base, messages, s.temperature, s.max_tokens, schema)

    def _key(self) -> str | None:
        s = self.settings
        return read_key(s.api_key_env, s.api_base, "model", "llm.api_base", "llm.api_key_env")
