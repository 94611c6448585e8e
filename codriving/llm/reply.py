"""One request to a model and the raw reply to it, before anybody has looked at what it says."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from codriving.errors import ModelError
from codriving.llm.question import Message

TOO_LONG = "context_length"
"""Finish reason of a request that was longer than the model's context; ours, no server sends it."""

UNREADABLE = "unreadable"
"""Finish reason of a reply that is no chat completion, for instance a web page; ours."""


@dataclass(frozen=True, slots=True)
class Request:
    """What is asked of a server, apart from the form of the answer.

    Attributes:
        api_base: Address of the server; None for the provider's own.
        temperature: Sampling temperature; None leaves it to the server.
        max_tokens: Longest answer [tokens].
        schema: JSON schema of the answer; None if any text will do.
    """

    model: str
    api_base: str | None
    messages: tuple[Message, ...]
    temperature: float | None
    max_tokens: int
    schema: Mapping[str, Any] | None

    def as_dict(self) -> dict[str, Any]:
        """Return it as JSON-ready data: what makes two requests the same."""
        return {
            "model": self.model,
            "api_base": self.api_base,
            "messages": [{"role": m.role, "content": m.content} for m in self.messages],
            "temperature": self.temperature,
            "max_tokens": self.max_tokens,
            "schema": self.schema,
        }


@dataclass(frozen=True, slots=True)
class Reply:
    """What a server sent.

    Attributes:
        cost: What it cost [USD]; None where no price is known.
        seconds: How long it took, retries included [s].
    """

    text: str
    finish_reason: str
    refusal: str = ""
    prompt_tokens: int = 0
    completion_tokens: int = 0
    cost: float | None = None
    form: str = ""
    seconds: float = 0.0
    attempts: int = 1

    def as_dict(self) -> dict[str, Any]:
        """Return it as JSON-ready data."""
        return asdict(self)

    @classmethod
    def from_dict(cls, stored: Mapping[str, Any]) -> "Reply":
        """Read what ``as_dict`` wrote.

        Raises:
            ModelError: If it was not written by this version.
        """
        try:
            return cls(**stored)
        except TypeError:
            pass
        raise ModelError("the file of llm.cache_file was written by another version; name another one")
