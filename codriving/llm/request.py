"""One request to a model: its messages, the form of its answer from the strictest to the plainest, the raw reply."""

import json
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from codriving.errors import ModelError
from codriving.llm.question import Message

if TYPE_CHECKING:
    from pydantic import BaseModel


# Finish reason of a request that was longer than the model's context; ours, no server sends it.
TOO_LONG = "context_length"

UNREADABLE = "unreadable"  # Finish reason of a reply that is no chat completion, for instance a web page; ours


@dataclass(frozen=True, slots=True)
class ChatRequest:
    """What is asked of a server, apart from the form of the answer."""

    model: str
    api_base: str | None  # Address of the server; None for the provider's own
    messages: tuple[Message, ...]
    temperature: float | None  # Sampling temperature; None leaves it to the server
    max_tokens: int  # Longest answer [tokens]
    schema: Mapping[str, Any] | None  # JSON schema of the answer; None if any text will do


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


class Forms:
    """The strictest form that each model is known to support; starts with the strictest there is."""

    def __init__(self) -> None:
        self._known: dict[tuple[str, str | None], int] = {}

    def best(self, model: str, api_base: str | None) -> str:
        """Return the form to ask in."""
        return FORMS[self._known.get((model, api_base), 0)]

    def step_down(self, model: str, api_base: str | None, refused: str) -> bool:
        """Remember that a form is not supported."""
        below = FORMS.index(refused) + 1
        if below == len(FORMS):
            return False
        # Questions that were asked at the same time are refused one after the other and step down once.
        self._known[model, api_base] = max(below, self._known.get((model, api_base), 0))
        return True


KNOWN = Forms()  # What this process knows; changed on the one loop alone
