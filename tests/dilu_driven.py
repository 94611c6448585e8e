"""DiLu as it is configured, with a rule or a scripted model behind its ports."""

import json
from collections.abc import Sequence
from typing import Any

from asked import Scripted
from worlds import Junction

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.experience import Experience, Memory
from codriving.datatypes.parts import CaseMemory
from codriving.datatypes.situation import Situation
from codriving.llm.language_model import Offline
from codriving.llm.question import Question
from codriving.llm.scripted import Script, ScriptedChat
from codriving.methods.dilu.dilu import DiLu
from codriving.methods.single_vehicle.demonstrated import Demonstrated

NEVER_HELD = 0.1
"""A time for which nothing is held: every step is decided."""


class Notebook(CaseMemory):
    """A memory that recalls what it is given and notes what it is to learn."""

    label, reflections = "notebook", 0

    def __init__(self, memories: Sequence[Memory] = (), learns: bool = True) -> None:
        self.memories, self.learns = tuple(memories), learns
        self.learnt: list[Experience] = []

    def recall(self, situations: Sequence[Situation]) -> list[tuple[Memory, ...]]:
        """The same for everybody."""
        return [self.memories for _ in situations]

    def learn(self, experiences: Sequence[Experience]) -> int:
        """Note it."""
        self.learnt += experiences
        return len(experiences)


def rule(**change: Any) -> Demonstrated:
    """The rule as it is configured, but for what is named."""
    node = dict(compose(["method=dilu"])["method"]["rule"])
    made = build({**node, **change}, object, "method")
    assert isinstance(made, Demonstrated)
    return made


def ruled(world: Junction, memory: CaseMemory | None = None, hold: float = 1.0, shots: int = 3) -> DiLu:
    """The method with its rule, ready for an episode."""
    made = DiLu(Offline(), memory, hold, shots, rule())
    made.reset(world.road_map, world.model, 0)
    return made


def modelled(
    world: Junction, script: Script, memory: CaseMemory | None = None, hold: float = 1.0
) -> tuple[DiLu, ScriptedChat]:
    """The method with a model, ready for an episode, and the model."""
    chat = ScriptedChat(script)
    made = DiLu(Scripted(chat), memory, hold, 3, rule())
    made.reset(world.road_map, world.model, 0)
    return made, chat


def always(action: str) -> Script:
    """Decides for one action again and again, and reflects that slowing down would have been right."""

    def script(question: Question) -> str:
        if question.purpose == "reflect":
            return json.dumps({"mistake": "V1 was overlooked.", "lesson": "Let them pass.", "action": "slower"})
        return json.dumps({"reason": "it is free", "action": action})

    return script


def text(question: Question) -> str:
    """All that a question says."""
    return "\n".join(message.content for message in question.messages)
