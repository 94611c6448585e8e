"""A chat that answers from a script, for tests: no server, no key, no wait."""

import asyncio
from collections.abc import Callable, Sequence
from dataclasses import replace

from pydantic import BaseModel

from codriving.llm.client import converse
from codriving.llm.question import Answer, Chat, Message, Question
from codriving.llm.request import Reply

# Gives the answer to a question as an object or in a model's words; an exception is raised.
Script = Callable[[Question], "BaseModel | str | Exception"]


class ScriptedChat(Chat):
    """Answers as its script says, and reads what the script says as if a model had said it."""

    def __init__(self, script: Script, name: str = "scripted") -> None:
        self.name = name
        self.questions: list[Question] = []
        self.rounds = 0
        self._script = script

    @property
    def calls(self) -> int:
        """How often the script was called."""
        return len(self.questions)

    def ask(self, questions: Sequence[Question]) -> list[Answer]:
        self.rounds += bool(questions)
        return [asyncio.run(converse(question, self._reply)) for question in questions]

    async def _reply(self, messages: tuple[Message, ...], question: Question) -> tuple[Reply, bool]:
        asked = replace(question, messages=messages)
        self.questions.append(asked)
        said = self._script(asked)
        if isinstance(said, Exception):
            raise said
        text = said.model_dump_json() if isinstance(said, BaseModel) else said
        return Reply(text, "stop", form="json_schema"), False
