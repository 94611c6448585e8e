"""What DiLu's model is told, as it reads."""

import json
import os
from dataclasses import replace
from pathlib import Path

import pytest
from asked import Scripted
from shown import GOLDEN, WORLDS, WRITE
from worlds import Junction

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.experience import Memory, Verdict
from codriving.datatypes.record import Collision, Ending, Outcome
from codriving.datatypes.world import Action
from codriving.llm.question import Question
from codriving.llm.scripted import ScriptedChat
from codriving.methods.dilu.dilu import DiLu

NEARER = {"intersection": 20.0, "roundabout": 20.0}
"""How much farther each vehicle is than on the other pages, since a vehicle on its own sees 50 m [m]."""


class Book:
    """Recalls one experience, and learns nothing."""

    label, learns, reflections = "book", True, 0

    def recall(self, situations: object) -> list[tuple[Memory, ...]]:
        """The same for each vehicle."""
        return [(Memory(1, "At 8.0 m/s: FASTER. No mistake.", Action.FASTER, Verdict.EASED, 0.97, 1),)] * len(
            list(situations)  # type: ignore[call-overload]
        )

    def learn(self, experiences: object) -> int:
        """Learn nothing."""
        return 0


def questions(world: Junction, scenario: str) -> list[Question]:
    """One decision on the world of a scenario, and a look back on it after CAV1 has run into CAV2."""

    def script(question: Question) -> str:
        if question.purpose == "reflect":
            return json.dumps({"mistake": "a", "lesson": "b", "action": "SLOWER"})
        return json.dumps({"reason": "nobody is there", "action": "IDLE"})

    chat = ScriptedChat(script)
    rule = build(compose(["method=dilu"])["method"]["rule"], object, "method")
    made = DiLu(Scripted(chat), Book(), 1.0, 3, rule)
    made.reset(world.road_map, world.model, 0)
    cars = [replace(one, place=one.place + NEARER.get(scenario, 0.0)) for one in WORLDS[scenario]]
    moment = world.world(*cars)
    made.act(moment)
    made.conclude(moment, Outcome(Ending.COLLISION, 1.5, {}, Collision(1.5, "CAV1", "CAV2", "CAV-CAV")))
    return chat.questions


@pytest.fixture(scope="module")
def everywhere(
    junction: Junction, roundabout: Junction, merge: Junction, highway: Junction
) -> dict[str, list[Question]]:
    worlds = {"intersection": junction, "roundabout": roundabout, "merge": merge, "highway": highway}
    return {name: questions(world, name) for name, world in worlds.items()}


@pytest.mark.parametrize("purpose", ["dilu", "dilu_reflect"])
@pytest.mark.parametrize("scenario", WORLDS)
def test_prompt_reads_as_it_did(everywhere: dict[str, list[Question]], scenario: str, purpose: str) -> None:
    wanted = "reflect" if purpose == "dilu_reflect" else "decide"
    asked = next(q for q in everywhere[scenario] if q.purpose == wanted and q.subject == "CAV1")
    page = "".join(f"# {m.role}\n\n{m.content}\n\n" for m in asked.messages).rstrip() + "\n"
    file = GOLDEN / f"{scenario}.{purpose}.md"
    if os.environ.get(WRITE):
        file.write_text(page, encoding="utf-8")
    assert page == file.read_text(encoding="utf-8"), f"if that is meant: {WRITE}=1 pytest {Path(__file__).name}"


@pytest.mark.parametrize("scenario", WORLDS)
def test_question_is_short_and_says_what_may_be_chosen(everywhere: dict[str, list[Question]], scenario: str) -> None:
    for question in everywhere[scenario]:
        assert sum(len(m.content) for m in question.messages) / 4 <= 800
        assert question.messages[1].content.splitlines()[-1].startswith("Allowed actions: ")
        assert "\n\n" not in question.messages[1].content
