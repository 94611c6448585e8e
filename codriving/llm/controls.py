"""Controls in the model's place: answers made from the form of a question alone, read as a model's answers are."""

import json
import random
from abc import abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha256
from typing import Any

from codriving.datatypes import Action
from codriving.llm.cache import AnswerCache
from codriving.llm.client import ModelChat
from codriving.llm.language_model import LanguageModel
from codriving.llm.request import ChatRequest, Reply
from codriving.llm.send import Sender

CONTROL = "control"  # The first word of the name of each, so that no table can show one as a model

# Actions from the fastest to the slowest; a lane change keeps the target speed, as IDLE does.
FASTEST = ("FASTER", "IDLE", "HOLD", "LANE_LEFT", "LANE_RIGHT", "SLOWER")

_ACTIONS = frozenset(map(str, Action))
_BYTES = 4  # Of a token, of which no server counts any here

# Chooses one of the words that a place of a form asks for.
Choose = Callable[[Sequence[Any]], Any]


def filled(form: Mapping[str, Any], choose: Choose, text: str) -> Any:  # noqa: ANN401 - any JSON
    """Fill in a form of answer.

    Args:
        form: Its JSON schema.
        text: What is said where any text will do.
    """
    return _filled(form, choose, text, form.get("$defs", {}))


def _filled(node: Mapping[str, Any], choose: Choose, text: str, known: Mapping[str, Any]) -> Any:  # noqa: ANN401
    if "$ref" in node:
        return _filled(known[node["$ref"].rpartition("/")[2]], choose, text, known)
    if "const" in node:
        return node["const"]
    if "enum" in node:
        return choose(node["enum"])
    for several in ("anyOf", "oneOf", "allOf"):
        if options := [one for one in node.get(several, ()) if one.get("type") != "null"]:
            return _filled(options[0], choose, text, known)
    kind = node.get("type", "object")
    if kind == "object":
        return {name: _filled(inner, choose, text, known) for name, inner in node.get("properties", {}).items()}
    if kind == "array":
        return [_filled(node["items"], choose, text, known) for _ in range(node.get("minItems", 0))]
    return {"string": text, "boolean": False, "null": None}.get(kind, node.get("minimum", 0))


class FormSender(Sender):
    """Answers each request in this process, from the form that it asks for and nothing else."""

    timed = False
    marked = True

    def __init__(self, chooser: Callable[[ChatRequest], Choose], text: str) -> None:
        self._chooser, self._text = chooser, text

    async def load(self) -> None:
        """Nothing has to be loaded."""

    async def send(
        self, request: ChatRequest, form: str, key: str | None, deadline: float, key_header: str | None = None
    ) -> Reply:
        """Answer a request; any text will do for one that asks for no form."""
        said = "yes" if request.schema is None else filled(request.schema, self._chooser(request), self._text)
        text = said if isinstance(said, str) else json.dumps(said, ensure_ascii=False)
        asked = sum(len(message.content.encode()) for message in request.messages)
        tokens = -(-asked // _BYTES), -(-len(text.encode()) // _BYTES)
        return Reply(text, "stop", prompt_tokens=tokens[0], completion_tokens=tokens[1], counted=False)


class StandIn(LanguageModel):
    """A control in the place of a model: asked with the same prompts, its answers read and counted alike."""

    waits = False
    says: str  # What it says where any text will do

    @property
    def name(self) -> str:  # type: ignore[override]
        return f"{CONTROL} {self.label or self.model}"

    @abstractmethod
    def chooser(self, request: ChatRequest) -> Choose:
        """Return what chooses among the words that a request asks for."""

    def key(self) -> None:
        """Return none: no server is asked."""

    def client(self, cache: AnswerCache | None) -> ModelChat:
        return ModelChat(self, cache, sender=FormSender(self.chooser, self.says))


class ControlFirst(StandIn):
    """``llm=first``: the fastest action that is allowed, and the vehicle that is named first goes first."""

    says = "the fastest that is allowed, the first that is named"

    def chooser(self, request: ChatRequest) -> Choose:
        """Take the fastest of actions, and the first of anything else."""

        def choose(words: Sequence[Any]) -> Any:  # noqa: ANN401 - any JSON
            return min(words, key=FASTEST.index) if _ACTIONS.issuperset(words) else words[0]

        return choose


@dataclass(frozen=True)
class ControlRandom(StandIn):
    """``llm=random``: any of the words that are asked for, drawn by the seed, the episode and what is asked."""

    says = "drawn at random"

    seed: int = 0  # Of the draws; the same one draws the same

    def chooser(self, request: ChatRequest) -> Choose:
        """Draw by what is asked where: alike for any number of workers, and anew when a question is repeated."""
        told = [self.seed, request.epoch, request.occasion, *(message.content for message in request.messages)]
        return random.Random(int.from_bytes(sha256(json.dumps(told).encode()).digest())).choice
