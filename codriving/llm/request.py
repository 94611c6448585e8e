"""One request to a model: its messages, the form of its answer from the strictest to the plainest, the raw reply."""

import json
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from functools import lru_cache
from itertools import combinations
from typing import TYPE_CHECKING, Any

from codriving.errors import ModelError
from codriving.llm.question import Message

if TYPE_CHECKING:
    from pydantic import BaseModel


# Finish reason of a request that was longer than the model's context; ours, no server sends it.
TOO_LONG = "context_length"

UNREADABLE = "unreadable"  # Finish reason of a reply that is no chat completion, for instance a web page; ours


LIMIT = "max_tokens"

# What a request can do without, or say in another way, by what a refusal calls it.
PLAINER: dict[str, dict[str, Any]] = {
    LIMIT: {"max_tokens_field": "max_completion_tokens"},
    "temperature": {"temperature": None},
    "system": {"system_role": "user"},
    "any limit": {"max_tokens_field": None},
}


@dataclass(frozen=True, slots=True)
class ChatRequest:
    """What is asked of a server, apart from the form of the answer."""

    model: str
    api_base: str | None  # Address of the server; None for the provider's own
    messages: tuple[Message, ...]
    temperature: float | None  # Sampling temperature; None leaves it to the server
    max_tokens: int  # Longest answer [tokens]
    schema: Mapping[str, Any] | None  # JSON schema of the answer; None if any text will do
    max_tokens_field: str | None = LIMIT  # What the limit is called; None sends none
    system_role: str = "system"
    stream: bool = False
    extra: Mapping[str, Any] = field(default_factory=dict)
    headers: Mapping[str, str] = field(default_factory=dict)
    epoch: int = 1  # Which time the same is asked
    occasion: str = ""  # Where it is asked, for what draws its answers; a server is not told

    def told(self) -> dict[str, Any]:
        """What an answer depends on, by which it is kept; what is not set is left out."""
        told = asdict(self)
        del told["stream"]
        plain: dict[str, Any] = {"max_tokens_field": LIMIT, "system_role": "system", "extra": {}, "headers": {}}
        plain |= {"epoch": 1, "occasion": ""}
        return {name: value for name, value in told.items() if name not in plain or value != plain[name]}

    def without(self, left_out: Iterable[str]) -> "ChatRequest":
        """Return a plainer request."""
        changes = {name: value for name in left_out for name, value in PLAINER[name].items()}
        return replace(self, **changes)


@dataclass(frozen=True, slots=True)
class Reply:
    """What a server sent."""

    text: str
    finish_reason: str
    refusal: str = ""
    prompt_tokens: int = 0
    completion_tokens: int = 0
    cost: float | None = None  # What it cost [USD]; None where no price is known
    form: str = ""
    seconds: float = 0.0  # How long it took, retries included [s]
    attempts: int = 1
    # What else may hold the answer, in order: arguments of tool calls, and what the model said to itself.
    beside: tuple[str, ...] = ()
    model: str = ""  # What the server calls the model
    counted: bool = True  # Whether the server counted the tokens; they are estimated otherwise
    cached_tokens: int = 0  # Of those of the prompt, the ones that the server had in its own cache
    reasoning_tokens: int = 0  # Of those of the answer, the ones with which the model spoke to itself

    @classmethod
    def from_dict(cls, stored: Mapping[str, Any]) -> "Reply":
        """Read what ``asdict`` gave."""
        with suppress(TypeError):
            return cls(**{**stored, "beside": tuple(stored.get("beside", ()))})
        raise ModelError("the file of llm.cache_file was written by another version; name another one")


FORMS = ("json_schema", "json_schema_any_length", "json_object", "text")  # Strictest first


@lru_cache(maxsize=256)
def schema_of(model: "type[BaseModel]") -> dict[str, Any]:
    """Write a form of answer as a JSON schema that the strict mode of servers takes.

    Strict mode wants every property required and none beside them.
    """
    return dict(_strict(model.model_json_schema()))


def _strict(node: Any, names: bool = False) -> Any:  # noqa: ANN401 - any JSON
    """Make a node strict; the keys of a mapping of ``names`` (properties, definitions) are not keywords."""
    if isinstance(node, list):
        return [_strict(inner) for inner in node]
    if not isinstance(node, dict):
        return node
    made = {
        key: _strict(inner, names=not names and key in ("properties", "$defs"))
        for key, inner in node.items()
        if names or key not in ("title", "default")
    }
    if not names and "properties" in made:
        made |= {"additionalProperties": False, "required": list(made["properties"])}
    return made


def response_format(form: str, schema: Mapping[str, Any] | None) -> dict[str, Any] | None:
    """Return what a request says about the form of its answer; None for nothing."""
    if schema is None or form == "text":
        return None
    if form == "json_object":
        return {"type": "json_object"}
    asked = dict(schema) if form == "json_schema" else _any_length(schema)
    return {"type": "json_schema", "json_schema": {"name": "answer", "strict": True, "schema": asked}}


def _any_length(node: Any) -> Any:  # noqa: ANN401 - any JSON
    """Leave out how long a text may be, which some servers do not take in a schema."""
    if isinstance(node, list):
        return [_any_length(inner) for inner in node]
    if not isinstance(node, dict):
        return node
    return {key: _any_length(inner) for key, inner in node.items() if key != "maxLength" or isinstance(inner, dict)}


def worded(messages: tuple[Message, ...], form: str, schema: Mapping[str, Any] | None) -> tuple[Message, ...]:
    """Describe the schema in the first user message where the form does not carry it."""
    if schema is None or form.startswith("json_schema"):
        return messages
    wish = (
        "Answer with one JSON object and nothing else, no code fence, no prose. It has to fit this JSON schema:\n"
        + json.dumps(schema, separators=(",", ":"), ensure_ascii=False)
    )
    at = next((index for index, message in enumerate(messages) if message.role == "user"), None)
    if at is None:
        return (*messages, Message("user", wish))
    return (*messages[:at], Message("user", f"{messages[at].content}\n\n{wish}"), *messages[at + 1 :])


def spoken(messages: tuple[Message, ...], system_role: str) -> tuple[Message, ...]:
    """Put the instructions into the role that a server knows, or before the first words of the user."""
    if system_role != "user":
        return tuple(Message(system_role, m.content) if m.role == "system" else m for m in messages)
    told = "\n\n".join(m.content for m in messages if m.role == "system")
    rest = [m for m in messages if m.role != "system"]
    if not told or not rest:
        return tuple(Message("user", m.content) if m.role == "system" else m for m in messages)
    at = next((index for index, m in enumerate(rest) if m.role == "user"), 0)
    return (*rest[:at], Message("user", f"{told}\n\n{rest[at].content}"), *rest[at + 1 :])


Way = tuple[str, tuple[str, ...]]  # How it is asked: the form, and what is left out


@dataclass(slots=True)
class _Known:
    """What is known of one model at one address."""

    form: int = 0
    proven: bool = False  # Whether that form has been answered
    left_out: tuple[str, ...] = ()


class Forms:
    """The strictest form that each model takes, and what its requests have to do without; begins with the strictest."""

    def __init__(self) -> None:
        self._known: dict[tuple[str, str | None], _Known] = {}

    def of(self, request: ChatRequest) -> _Known:
        """What is known of the model that is asked."""
        return self._known.setdefault((request.model, request.api_base), _Known())

    def best(self, request: ChatRequest) -> Way:
        """Return the form to ask in, and what to leave out."""
        known = self.of(request)
        return FORMS[known.form] if request.schema else "text", known.left_out

    def proven(self, request: ChatRequest) -> bool:
        """Whether the form to ask in has been answered."""
        return self.of(request).proven

    def settle(self, request: ChatRequest, form: str, left_out: tuple[str, ...]) -> bool:
        """Take note of a request that was answered; tells whether something has to be left out from now on."""
        known = self.of(request)
        news = len(left_out) > len(known.left_out) and not known.proven
        if news:
            known.left_out = left_out
        if request.schema is not None and not known.proven:
            # Questions that were asked at the same time are refused one after the other.
            known.form, known.proven = max(FORMS.index(form), known.form), True
        return news


def plainer(form: str, left_out: tuple[str, ...], schema: bool, first: bool, told: str) -> Iterator[Way]:
    """Yield plainer ways of asking than one that was refused.

    Args:
        schema: Whether an answer of a form is asked for.
        first: Whether nothing has been answered yet, so that any field may be the reason.
        told: What the server said; what it names is left out first.
    """
    if schema:
        yield from ((below, left_out) for below in FORMS[FORMS.index(form) + 1 :])
    if first:
        names = sorted((LIMIT, "temperature", "system"), key=lambda name: name not in told.lower())
        for number in (1, 2, 3):
            yield from (("text", some) for some in combinations(names, number))
    if first or schema:
        yield "text", ("temperature", "any limit", *(["system"] if first else left_out))


KNOWN = Forms()  # What this process knows; changed on the one loop alone
