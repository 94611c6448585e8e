"""A model for tests that answers from the prompt alone, and the method with that model behind its ports."""

import json
import re
from dataclasses import dataclass
from typing import Any

from worlds import FULL, Junction

from codriving.datatypes.parts import Model
from codriving.llm.ledger import Ledger
from codriving.llm.question import Question
from codriving.llm.scripted import Script, ScriptedChat
from codriving.methods.codriving import CoDriving
from codriving.reasoning.sharing.sharing import CdaLevel


@dataclass
class Scripted(Model):
    """A reasoner with a script behind it."""

    scripted: ScriptedChat
    max_concurrency: int = 1
    failures_in_a_row: int = 1
    cache: str = "off"
    prompts: str | None = None
    ask_plain: bool = False
    thoughts: bool = False
    name: str = "scripted"

    def chat(self) -> ScriptedChat:
        """The chat that answers by the script."""
        return self.scripted


@dataclass
class Reasoned:
    """The method, its model, and where the answers are noted."""

    method: CoDriving
    chat: ScriptedChat
    ledger: Ledger

    @property
    def prompts(self) -> list[str]:
        """Everything that was asked, as text."""
        return ["\n".join(m.content for m in q.messages) for q in self.chat.questions]


def reasoned(world: Junction, script: Script, **change: Any) -> Reasoned:
    """The method with a model behind its ports, ready for an episode; what differs from the full framework is named."""
    asked = {key: change.pop(key) for key in ("ask_plain", "prompts", "thoughts") if key in change}
    model = Scripted(ScriptedChat(script), **asked)
    level = CdaLevel(**{**FULL, **change})
    method = CoDriving(level, model, None, 1.5)
    method.reset(world.road_map, world.model, 0)
    assert method._model is not None
    return Reasoned(method, model.scripted, method._model.ledger)


def shown(question: Question) -> str:
    """The last thing that a question says."""
    return question.messages[-1].content


def allowed(question: Question) -> list[str]:
    """The actions that a decision prompt allows."""
    [line] = re.findall(r"^Allowed actions: (.*)$", question.messages[1].content, re.MULTILINE)
    return str(line).split(", ")


def pairs(question: Question) -> dict[str, tuple[str, str]]:
    """The pairs that a negotiation prompt asks about."""
    block = question.messages[1].content.split("Pairs to order:\n")[1]
    return {name: (one, other) for name, one, other in re.findall(r"^- (\S+): (\S+) and (\S+) \(", block, re.M)}


def orders(*said: tuple[str, str]) -> str:
    """The text of an answer to a negotiation: who goes first in which pair."""
    return json.dumps(
        {"orders": [{"pair": pair, "first": first, "reason": "it can be there earlier"} for pair, first in said]}
    )


def sensible(question: Question) -> str:
    """Take the action that gets farthest, the fastest if equal; in a pair let the one go that is there earlier."""
    text = question.messages[1].content
    if question.purpose == "negotiate":
        earliest = {name: float(t) for name, t in re.findall(r"^- (\S+): .*?earliest ([\d.]+) s", text, re.M)}
        return orders(*((name, min(pair, key=lambda v: (earliest[v], v))) for name, pair in pairs(question).items()))
    order = ["SLOWER", "HOLD", "IDLE", "FASTER", "LANE_LEFT", "LANE_RIGHT"]
    gains: dict[str, int] = {}
    for words, gain in re.findall(r"^- ([A-Z_, ]+): gets (\d+) m", text, re.M):
        gains.update(dict.fromkeys(words.split(", "), int(gain)))
    best = max(allowed(question), key=lambda a: (gains.get(a, -1) - 5 * a.startswith("LANE"), order.index(a)))
    return json.dumps({"reason": "it gets farthest", "action": best})


def deciding(*texts: str) -> Script:
    """Answers decisions with given texts, one after the other, the last one again and again; negotiates sensibly."""
    left = list(texts)

    def script(question: Question) -> str:
        if question.purpose == "negotiate":
            return sensible(question)
        return left.pop(0) if len(left) > 1 else left[0]

    return script


def negotiating(*texts: str) -> Script:
    """Answers negotiations with given texts, one after the other, the last one again and again; decides sensibly."""
    left = list(texts)

    def script(question: Question) -> str:
        if question.purpose != "negotiate":
            return sensible(question)
        return left.pop(0) if len(left) > 1 else left[0]

    return script
