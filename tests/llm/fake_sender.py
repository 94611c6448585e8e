"""A server without a network, for tests of what is made of its replies."""

import asyncio
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import replace
from typing import Literal

from pydantic import BaseModel

from codriving.llm.cache import AnswerCache
from codriving.llm.client import ModelChat
from codriving.llm.faults import CallError
from codriving.llm.question import Message, Question
from codriving.llm.request import ChatRequest, Forms, Reply
from codriving.llm.send import Sender
from codriving.llm.settings import ModelSettings
from codriving.llm.spending import Spending

GOOD = '{"reason": "free", "action": "IDLE"}'

Said = Reply | Exception | str
Behaviour = Sequence[Said] | Callable[[ChatRequest, str], Said | Awaitable[Said]]


class Choice(BaseModel):
    """What is asked for."""

    reason: str
    action: Literal["IDLE", "SLOWER"]


def question(text: str = "Choose.", **changes: object) -> Question:
    messages = (Message("system", "You drive."), Message("user", text))
    return Question("decide", "cav_0", messages, Choice, **changes)  # type: ignore[arg-type]


class FakeSender(Sender):
    """Replies from a list, then always well; or as a function of request and form says."""

    def __init__(self, behaviour: Behaviour = ()) -> None:
        self.sent: list[tuple[ChatRequest, str, str | None]] = []
        self.now = self.most = 0
        self._behaviour = behaviour

    async def load(self) -> None:
        """Nothing takes long here."""

    async def send(
        self, request: ChatRequest, form: str, key: str | None, deadline: float, key_header: str | None = None
    ) -> Reply:
        """Note the request and reply to it."""
        self.sent.append((request, form, key))
        self.now += 1
        self.most = max(self.most, self.now)
        try:
            await asyncio.sleep(0)
            said = await self._say(request, form)
        finally:
            self.now -= 1
        if isinstance(said, Exception):
            raise said
        return said if isinstance(said, Reply) else reply(said, form=form)

    async def _say(self, request: ChatRequest, form: str) -> Said:
        if not callable(self._behaviour):
            return self._behaviour[len(self.sent) - 1] if len(self.sent) <= len(self._behaviour) else GOOD
        said = self._behaviour(request, form)
        return said if isinstance(said, Reply | Exception | str) else await said


def reply(text: str = GOOD, finish_reason: str = "stop", **fields: object) -> Reply:
    return Reply(text, finish_reason, prompt_tokens=100, completion_tokens=10, **fields)  # type: ignore[arg-type]


class Waits(list[float]):
    """Stands in for sleeping: notes how long it would have been."""

    async def __call__(self, seconds: float) -> None:
        """Wait no time at all."""
        self.append(seconds)


SETTINGS = ModelSettings(
    model="openai/fake",
    api_base="http://server/v1",
    api_key_env=None,
    temperature=0.0,
    max_tokens=300,
    deadline=30.0,
    attempts=4,
    max_concurrency=8,
    cache="off",
    cache_file="answers.sqlite",
    max_cost=None,
    max_tokens_total=None,
    input_cost_per_token=1e-6,
    output_cost_per_token=2e-6,
    failures_in_a_row=5,
    ask_plain=False,
    latency="none",
    prompts=None,
    thoughts=False,
    label=None,
    model_prefix=None,
    max_tokens_field="max_tokens",
    system_role="system",
    stream=False,
    extra={},
    headers={},
    api_key_header=None,
    fallbacks_at_first=20,
    epoch=1,
)


def chat(
    sender: FakeSender,
    waits: Waits | None = None,
    cache: AnswerCache | None = None,
    spending: Spending | None = None,
    replay: bool = False,
    **changes: object,
) -> ModelChat:
    settings = replace(SETTINGS, cache="replay" if replay else "off", **changes)  # type: ignore[arg-type]
    return ModelChat(settings, cache, spending, sender, Waits() if waits is None else waits, Forms())


__all__ = ["GOOD", "SETTINGS", "CallError", "Choice", "FakeSender", "Waits", "chat", "question", "reply"]
