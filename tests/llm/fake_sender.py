"""A server without a network, for tests of what is made of its replies."""

import asyncio
from collections.abc import Awaitable, Callable, Sequence
from typing import Literal

from pydantic import BaseModel

from codriving.llm.client import ModelChat
from codriving.llm.faults import CallError
from codriving.llm.forms import Forms
from codriving.llm.question import Message, Question
from codriving.llm.reply import Reply, Request
from codriving.llm.settings import Cache, Settings
from codriving.llm.spending import Spending

GOOD = '{"reason": "free", "action": "IDLE"}'

Said = Reply | Exception | str
Behaviour = Sequence[Said] | Callable[[Request, str], Said | Awaitable[Said]]


class Choice(BaseModel):
    """What is asked for."""

    reason: str
    action: Literal["IDLE", "SLOWER"]


def question(text: str = "Choose.", **changes: object) -> Question:
    messages = (Message("system", "You drive."), Message("user", text))
    return Question("decide", "cav_0", messages, Choice, **changes)  # type: ignore[arg-type]


class FakeSender:
    """Replies from a list, then always well; or as a function of request and form says."""

    def __init__(self, behaviour: Behaviour = ()) -> None:
        self.sent: list[tuple[Request, str, str | None]] = []
        self.now = self.most = 0
        self._behaviour = behaviour

    async def load(self) -> None:
        """Nothing takes long here."""

    async def send(self, request: Request, form: str, key: str | None, deadline: float) -> Reply:
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

    async def _say(self, request: Request, form: str) -> Said:
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


def chat(
    sender: FakeSender,
    waits: Waits | None = None,
    cache: Cache | None = None,
    spending: Spending | None = None,
    **changes: object,
) -> ModelChat:
    settings = {
        "model": "openai/fake",
        "api_base": "http://server/v1",
        "api_key_env": None,
        "temperature": 0.0,
        "max_tokens": 300,
        "deadline": 30.0,
        "attempts": 4,
        "max_concurrency": 8,
    }
    return ModelChat(
        Settings(**(settings | changes)),  # type: ignore[arg-type]
        price=lambda prompt, completion: prompt * 1e-6 + completion * 2e-6,
        spending=spending or Spending(),
        cache=cache,
        sender=sender,
        sleep=Waits() if waits is None else waits,
        forms=Forms(),
    )


__all__ = ["GOOD", "CallError", "Choice", "FakeSender", "Waits", "chat", "question", "reply"]
