"""What a language model is asked, and what comes back."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pydantic import BaseModel


@dataclass(frozen=True, slots=True)
class Message:
    """One message of a conversation."""

    role: str  # ``system``, ``user`` or ``assistant``
    content: str


@dataclass(frozen=True)
class Question:
    """One question."""

    purpose: str  # ``negotiate``, ``decide`` or ``reflect``
    subject: str
    messages: tuple[Message, ...]
    schema: "type[BaseModel]"
    check: "Callable[[BaseModel], str]" = lambda answer: ""
    # Gives the same question with less in it, if the model's context is too short; None if nothing more can be left
    # out.
    shorter: "Callable[[], Question | None]" = lambda: None
    more_tokens: int = 0  # How much longer the answer may be than ``llm.max_tokens`` [tokens]
    occasion: str = ""  # What tells it from the same words at another place of an episode; no part of what is asked


@dataclass(frozen=True, slots=True)
class Call:
    """One request that was answered or failed for good."""

    messages: tuple[Message, ...]
    text: str
    form: str  # How the answer was asked for, see ``FORMS``
    prompt_tokens: int
    completion_tokens: int
    cost: float | None  # What it cost [USD]; None where no price is known
    seconds: float  # How long it took, retries included [s]; of a cached answer, how long it took when it was asked
    attempts: int
    cached: bool
    problem: str = ""
    model: str = ""  # What the server calls the model, if that is another name than it was asked by
    finish_reason: str = ""  # Why the answer ends, in the words of the server
    cached_tokens: int = 0  # Of those of the prompt, the ones that the server had in its own cache
    reasoning_tokens: int = 0  # Of those of the answer, the ones with which the model spoke to itself


@dataclass(frozen=True, slots=True)
class Answer:
    """What became of a question."""

    value: "BaseModel | None"  # The answer, or None if the model gave none that can be used
    calls: tuple[Call, ...]
    problem: str = ""
    shortened: int = 0
    mended: bool = False  # Whether only the tolerant reading found it

    @property
    def asked_again(self) -> bool:
        """Whether the model was asked again because its first answer could not be used."""
        return len(self.calls) - self.shortened > 1


class Chat(ABC):
    """A language model that answers questions."""

    name: str

    @abstractmethod
    def ask(self, questions: Sequence[Question]) -> list[Answer]:
        """Ask several questions at once and wait for all answers.

        Raises:
            ModelUnavailableError: If the server cannot be reached, refuses or is too slow, retries included.
            SpendingLimitError: If the tokens or the money that may be spent are used up.
        """
