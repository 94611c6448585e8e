"""A language model that answers questions, all of a step at once: from the cache, or in the best form it takes."""

import asyncio
import json
import time
from collections.abc import Awaitable, Callable, Iterator, Sequence
from dataclasses import asdict, replace
from functools import partial
from typing import Any
from weakref import WeakValueDictionary

from codriving.errors import ModelError
from codriving.llm.answers import CUT_OFF, judge, split_thoughts
from codriving.llm.attempts import SLOWLY, ConcurrencyLimit, Retries, Retry, Sleep
from codriving.llm.cache import AnswerCache
from codriving.llm.faults import SLOW, CallError, FaultKind, unavailable, unusable
from codriving.llm.loop import loop
from codriving.llm.parsing import one_line
from codriving.llm.question import Answer, Call, Chat, Message, Question
from codriving.llm.request import (
    KNOWN,
    TOO_LONG,
    UNREADABLE,
    ChatRequest,
    Forms,
    Reply,
    Way,
    plainer,
    schema_of,
    worded,
)
from codriving.llm.send import Sender
from codriving.llm.settings import ModelSettings
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
        if spent := read.value is None and used_up(reply):
            read = replace(read, problem=USED_UP)
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
            model=reply.model,
            finish_reason=one_line(reply.finish_reason, 40),
            cached_tokens=reply.cached_tokens,
            reasoning_tokens=reply.reasoning_tokens,
        )
        calls.append(call)
        if reply.finish_reason == TOO_LONG:
            shorter = question.shorter()
            if shorter is None:
                return Answer(None, tuple(calls), read.problem, shortened)
            question, shortened = shorter, shortened + 1
        elif read.value is not None or again or spent:
            # What was used up is used up again, whatever is asked for.
            return Answer(read.value, tuple(calls), read.problem, shortened, read.mended)
        else:
            # Some servers insist that user and assistant take turns.
            wish = "Answer again, with one JSON object of the form asked for."
            said = Message("assistant", one_line(reply.text, 2000) or "(no answer)")
            again = (said, Message("user", f"This answer cannot be used: {read.problem}. {wish}"))


USED_UP = "the answer was cut off at the token limit before it began, all tokens having gone into thinking"


def used_up(reply: Reply) -> bool:
    """Whether a model thought until its tokens were used up."""
    return reply.finish_reason.lower() in CUT_OFF and not split_thoughts(reply.text)[0].strip()


_GREETING = (Message("system", "You check that a connection works."), Message("user", "Answer with the one word: yes"))

# Failures that are replies of a kind, by the finish reason that they are given: the question has to change.
_FINISH_REASONS = {FaultKind.TOO_LONG: TOO_LONG, FaultKind.FILTERED: "content_filter", FaultKind.UNREADABLE: UNREADABLE}

_MORE_TOKENS = "raise llm.max_tokens, or switch thinking off, for instance by llm.extra"

# Failures that no later episode would escape, if nothing has worked yet.
_FOR_GOOD = (FaultKind.KEY, FaultKind.MODEL, FaultKind.UNREACHABLE, FaultKind.REDIRECT, FaultKind.VARIABLE)


_BYTES = 4  # Of a token, where the server counts none

_CURES = {
    "max_tokens": "llm.max_tokens_field=max_completion_tokens",
    "temperature": "llm.temperature=null",
    "system": "llm.system_role=user",
    "any limit": "llm.max_tokens_field=null",
}


def _left_out(names: Sequence[str]) -> str:
    refused = ", ".join({"system": "the role system"}.get(name, name) for name in names)
    return f"the server refuses {refused}; left out from now on, as with {' '.join(_CURES[name] for name in names)}"


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
        self.name, self.settings = settings.label or settings.model, settings
        self.spending = spending or Spending(settings.max_cost, settings.max_tokens_total)
        self.on_retry: Callable[[Retry], None] = lambda retry: None
        self.on_note: Callable[[str], None] = lambda note: None
        self.served = ""  # What the server calls the model; empty until it has answered
        self._noted: set[str] = set()
        self._times: list[float] = []  # How long its answers took [s]
        self._usable, self._unusable = 0, 0
        self._cache, self._sender, self._forms = cache, sender or Sender(), forms
        self._worked = False
        self._limit = ConcurrencyLimit(settings.max_concurrency)
        limits = settings.attempts, settings.deadline
        self._retries = Retries(self.name, *limits, lambda retry: self.on_retry(retry), sleep)
        self._under_way: WeakValueDictionary[str, asyncio.Lock] = WeakValueDictionary()

    def ask(self, questions: Sequence[Question]) -> list[Answer]:
        if not questions:
            return []
        self.spending.check()
        answers = loop().run(self._ask_all(questions))
        self._count(answers)
        return answers

    def _count(self, answers: Sequence[Answer]) -> None:
        """Stop the batch of a model that has given no answer that can be used from its beginning."""
        self._usable += sum(answer.value is not None for answer in answers)
        self._unusable += sum(answer.value is None for answer in answers)
        spent = next((True for answer in answers if answer.problem == USED_UP), False)
        if spent:
            self._note(f"{USED_UP} (llm.max_tokens={self.settings.max_tokens}); {_MORE_TOKENS}")
        if not self._usable and self._unusable >= self.settings.fallbacks_at_first:
            problem = answers[-1].problem.rstrip(".")
            cure = _MORE_TOKENS if spent else "see what codriving check says, or raise llm.fallbacks_at_first"
            raise ModelError(
                f"{self.name} gave no usable answer to the first {self._unusable} questions (llm.fallbacks_at_first), "
                f"the last time since {problem}; {cure}"
            )

    @property
    def never_answered(self) -> int:
        """How many questions had no usable answer, if none had one."""
        return 0 if self._usable else self._unusable

    def _note(self, note: str) -> None:
        """Say something about the model once."""
        if note not in self._noted:
            self._noted.add(note)
            self.on_note(f"{self.name}: {note}")

    def preflight(self) -> None:
        """Make one short call before the first episode, unless one has worked already or the cache alone answers."""
        if self.settings.cache == "replay" or self._worked:
            return
        self.spending.check()
        self.settings.key()
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
        request = replace(request, occasion=question.occasion if self._sender.marked else "")
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
        wanted = request.told()
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
        begun = time.perf_counter()
        reply = await self._ask_plainer(request)
        self._worked = True
        self.served = reply.model or self.served
        alike = request.model.endswith(reply.model) or reply.model.endswith(request.model)
        reply = replace(self._counted(reply, request), model="" if alike else reply.model)
        prices = self.settings.input_cost_per_token, self.settings.output_cost_per_token
        cost = cost_of(self.settings.model, reply.prompt_tokens, reply.completion_tokens, *prices)
        self.spending.add(reply.prompt_tokens, reply.completion_tokens, cost)
        seconds = round(time.perf_counter() - begun, 3) if self._sender.timed else 0.0
        return replace(reply, cost=cost, seconds=seconds)

    async def _ask_plainer(self, request: ChatRequest) -> Reply:
        """Ask, and where the request is refused ask in a plainer way; what works is remembered.

        It is judged by what was sent: a server that has answered before refuses the form or a field, in whatever words.
        """
        form, left_out = self._forms.best(request)
        ways: Iterator[Way] | None = None
        sent, first = 0, None
        while True:
            try:
                asked = partial(self._attempt, request.without(left_out), form)
                reply, made = await self._retries.run(asked, self._may_pass)
                break
            except CallError as fault:
                sent += fault.attempts
                fault.attempts = sent
                if fault.kind in _FINISH_REASONS:
                    return Reply("", _FINISH_REASONS[fault.kind], refusal=fault.detail, form=form, attempts=sent)
                first = first or fault
                if not self._may_be_plainer(fault, request):
                    raise
                if ways is None:
                    ways = plainer(form, left_out, request.schema is not None, not self._worked, fault.detail)
                way = next(ways, None)
                if way is None:
                    raise (fault if self._worked else first) from None
            form, left_out = way
        if self._forms.settle(request, form, left_out):
            self._note(_left_out(left_out))
        return replace(reply, form=form, attempts=sent + made)

    def _may_be_plainer(self, fault: CallError, request: ChatRequest) -> bool:
        if fault.kind in (FaultKind.FORM, FaultKind.REFUSED):
            return True
        if fault.kind is FaultKind.MODEL:
            return self._worked or "model" not in fault.detail.lower()
        # Some servers fail at a form that they do not know, and some sell it: the greeting had the same key.
        new = request.schema is not None and not self._forms.proven(request)
        may = fault.kind is FaultKind.SERVER or fault.detail.startswith(("402:", "403:"))
        return may and self._worked and new

    def _counted(self, reply: Reply, request: ChatRequest) -> Reply:
        """Estimate the tokens of a server that does not count them: limits and tables would go without."""
        if reply.prompt_tokens or reply.finish_reason in (TOO_LONG, "content_filter"):
            return reply
        words = worded(request.messages, reply.form, request.schema)
        prompt = sum(len(message.content.encode()) for message in words)
        said = reply.completion_tokens or -(-len(reply.text.encode()) // _BYTES)
        self._note(f"the server counts no tokens; they are estimated, {_BYTES} bytes each")
        return replace(reply, prompt_tokens=-(-prompt // _BYTES), completion_tokens=said, counted=False)

    async def _attempt(self, request: ChatRequest, form: str) -> Reply:
        async with self._limit.slot() as ticket:
            begun, s = time.perf_counter(), self.settings
            sending = self._sender.send(request, form, self.settings.key(), s.deadline, s.api_key_header)
            try:
                reply = await self._retries.within_deadline(sending)
            except CallError as fault:
                if fault.kind is FaultKind.RATE:
                    self._limit.shrink(ticket)
                if fault.kind is FaultKind.TIMEOUT:
                    self._limit.shrink(ticket, SLOWLY)
                    fault.detail = f"{fault.detail or f'{s.deadline:g} s'}; {self._seen()}"
                    self._note(f"answers come too late; {SLOW}")
                raise
            self._limit.grow()
            self._times.append(time.perf_counter() - begun)
            return reply

    def _seen(self) -> str:
        """Say how long answers took, in the line about one that took too long."""
        if not self._times:
            return "no answer so far"
        low, high = min(self._times), max(self._times)
        return f"answers took {low:.1f} to {high:.1f} s, now {self._limit.limit} at once"

    def _may_pass(self, fault: CallError) -> bool:
        # Before anything has worked, an address at which no server listens is a wrong address.
        return fault.kind.passes and (self._worked or fault.kind is not FaultKind.UNREACHABLE)

    def _request(self, messages: tuple[Message, ...], schema: dict[str, Any] | None) -> ChatRequest:
        s = self.settings
        asked = ChatRequest(s.model, s.address, messages, s.temperature, s.max_tokens, schema)
        asked = replace(asked, max_tokens_field=s.max_tokens_field, system_role=s.system_role)
        return replace(asked, extra=s.extra, headers=s.headers, stream=s.stream, epoch=s.epoch)
