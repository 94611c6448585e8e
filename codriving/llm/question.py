"""What a language model is asked, and what comes back."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from pydantic import BaseModel


@dataclass(frozen=True, slots=True)
class Message:
    """One message of a conversation.

    Attributes:
        role: ``system``, ``user`` or ``assistant``.
        content: The text.
    """

    role: str
    content: str


@dataclass(frozen=True)
class Question:
    """One question.

    Attributes:
        purpose: ``negotiate``, ``decide`` or ``reflect``.
        subject: Whom it is about, for instance the id of a CAV; empty if about all.
        messages: The conversation so far.
        schema: The form that the answer must have.
        check: Says what is wrong with an answer of that form, in words that the model is told; empty if nothing is.
        shorter: Gives the same question with less in it, if the model's context is too short; None if nothing more
            can be left out.
    """

    purpose: str
    subject: str
    messages: tuple[Message, ...]
    schema: "type[BaseModel]"
    check: "Callable[[BaseModel], str]" = lambda answer: ""
    shorter: "Callable[[], Question | None]" = lambda: None


@dataclass(frozen=True, slots=True)
class Call:
    """One request that was answered or failed for good.

    Attributes:
        messages: What was sent.
        text: What came back; empty if nothing did.
        form: How the answer was asked for: ``json_schema``, ``json_object`` or ``text``.
        prompt_tokens: Tokens of the prompt.
        completion_tokens: Tokens of the answer.
        cost: What it cost [USD]; None where no price is known.
        seconds: How long it took, retries included [s]; of a cached answer, how long it took when it was asked.
        attempts: How often it was sent.
        cached: Whether it came from the cache.
        problem: What was wrong with the answer; empty if nothing was.
    """

    messages: tuple[Message, ...]
    text: str
    form: str
    prompt_tokens: int
    completion_tokens: int
    cost: float | None
    seconds: float
    attempts: int
    cached: bool
    problem: str = ""


@dataclass(frozen=True, slots=True)
class Answer:
    """What became of a question.

    Attributes:
        value: The answer, or None if the model gave none that can be used.
        calls: Every call that was made for it, in order; two if it was asked again.
        problem: Why there is no answer; empty if there is one.
        shortened: How often the question had to be shortened.
    """

    value: "BaseModel | None"
    calls: tuple[Call, ...]
    problem: str = ""
    shortened: int = 0

    @property
    def asked_again(self) -> bool:
        """Whether the model was asked again because its first answer could not be used."""
        return len(self.calls) - self.shortened > 1


class Chat(Protocol):
    """A language model that answers questions.

    Attributes:
        name: Name of the model, for tables.
    """

    name: str

    def ask(self, questions: Sequence[Question]) -> list[Answer]:
        """Ask several questions at once and wait for all answers.

        Args:
            questions: The questions; may be empty.

        Returns:
            One answer a question, in the same order; one that cannot be used has no value.

        Raises:
            ModelUnavailableError: If the server cannot be reached, refuses or is too slow, retries included.
            SpendingLimitError: If the tokens or the money that may be spent are used up.
        """
        ...


def as_line(purpose: str, subject: str, time: float, answer: Answer) -> dict[str, Any]:
    """Write an answer down as one JSON-ready line of ``transcript.jsonl``.

    Args:
        purpose: What was asked for.
        subject: Whom it was about.
        time: Simulated time [s].
        answer: What became of it.
    """
    return {
        "time": time,
        "purpose": purpose,
        "subject": subject,
        "value": None if answer.value is None else answer.value.model_dump(mode="json"),
        "problem": answer.problem,
        "shortened": answer.shortened,
        "calls": [
            {
                "messages": [{"role": m.role, "content": m.content} for m in call.messages],
                "text": call.text,
                "form": call.form,
                "prompt_tokens": call.prompt_tokens,
                "completion_tokens": call.completion_tokens,
                "cost": call.cost,
                "seconds": call.seconds,
                "attempts": call.attempts,
                "problem": call.problem,
            }
            for call in answer.calls
        ],
    }
