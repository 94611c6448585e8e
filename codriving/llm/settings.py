"""What a client is told to do, and what it keeps its accounts in."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol


@dataclass(frozen=True)
class Settings:
    """What a client does.

    Attributes:
        api_base: Address of the server; None for the provider's own.
        api_key_env: Name of the environment variable with the key; None if no key is needed.
        temperature: Sampling temperature; None leaves it to the server.
        max_tokens: Longest answer [tokens].
        deadline: How long one attempt may take [s].
    """

    model: str
    api_base: str | None
    api_key_env: str | None
    temperature: float | None
    max_tokens: int
    deadline: float
    attempts: int
    max_concurrency: int
    replay: bool = False


class Cache(Protocol):
    """Keeps replies; see ``codriving.llm.cache``."""

    def find(self, request: Mapping[str, Any]) -> dict[str, Any] | None:
        """Return the reply to a request, if there is one."""
        ...

    def keep(self, request: Mapping[str, Any], reply: Mapping[str, Any]) -> dict[str, Any]:
        """Keep a reply, and return the one that is kept: an earlier one, if there is one by now."""
        ...


class Purse(Protocol):
    """Counts what is spent; see ``codriving.llm.spending``."""

    def check(self) -> None:
        """Refuse to go on if a limit is reached."""
        ...

    def add(self, prompt_tokens: int, completion_tokens: int, cost: float | None) -> None:
        """Note what a reply cost."""
        ...
