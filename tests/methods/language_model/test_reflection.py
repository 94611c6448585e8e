"""Lessons by a language model: what it is asked, what is kept, and that the rules' comment stays."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from asked import Scripted
from driven import drive
from remembered import experience, online
from worlds import FULL, Junction

from codriving.datatypes.experience import Effect, Verdict
from codriving.datatypes.world import Action
from codriving.errors import ConfigError, ModelUnavailableError
from codriving.llm.language_model import Offline
from codriving.llm.ledger import Ledger
from codriving.llm.prompts.render import Prompts
from codriving.llm.question import Question
from codriving.llm.scripted import ScriptedChat
from codriving.memory.effect import LESSONS
from codriving.memory.embedders import FeatureEmbedder
from codriving.memory.snapshot import open_snapshot
from codriving.methods.codriving import CoDriving
from codriving.methods.language_model.prompted_model import PromptedModel
from codriving.methods.language_model.reflection import reflect
from codriving.reasoning.sharing.sharing import CdaLevel


def teacher(question: Question) -> str:
    return '{"lesson": "Yield earlier."}' if question.purpose == "reflect" else "no JSON"


LEARNT = [
    experience(step=1),
    experience(step=2, verdict=Verdict.EASED),
    replace(experience(step=3), effect=Effect(1.0, 0.5, -2.0)),
    experience(step=4, action=Action.IDLE, verdict=Verdict.TOO_CAUTIOUS),
    replace(experience(step=5), effect=Effect(1.0, 0.5, -0.1, collision=1.5, to_blame=True)),
]


def test_the_worst_mistakes_are_reflected_on_and_nothing_else() -> None:
    chat, ledger = ScriptedChat(teacher), Ledger()
    found = reflect(PromptedModel(chat, Prompts(), ledger), LEARNT, 3)
    taught = [e.step for e in found if "Yield earlier." in e.lesson]
    assert taught == [1, 3, 5]
    assert all(e.lesson.startswith(LESSONS[e.verdict]) for e in found)
    assert [replace(e, lesson="") for e in found] == [replace(e, lesson="") for e in LEARNT]
    assert ledger.close_step(0.0)[0]["model_calls"] == 3
    assert chat.rounds == 1


def test_the_model_is_told_what_came_of_it_and_no_names() -> None:
    chat = ScriptedChat(teacher)
    reflect(PromptedModel(chat, Prompts(), Ledger()), LEARNT, 1)
    text = "\n".join(m.content for m in chat.questions[0].messages)
    assert "1.5 s later it was in a collision" in text
    assert "The CAV chose FASTER." in text
    assert LESSONS[Verdict.INTENSIFIED] in text
    assert "CAV1" not in text
    assert "20 m and 2.5 s before the zone, it 28 m and 3.5 s, second." in text
    assert "TTCP" not in text


@pytest.mark.parametrize("said", ["{}", '{"lesson": " "}', "nothing of the kind"])
def test_without_a_usable_answer_the_comment_of_the_rules_stays(said: str) -> None:
    ledger = Ledger()
    assert reflect(PromptedModel(ScriptedChat(lambda _: said), Prompts(), ledger), LEARNT, 9) == LEARNT
    assert ledger.close_step(0.0)[0]["fallbacks"] == 4


@pytest.mark.parametrize("said", ["one or two short sentences", "...", "Lesson", LESSONS[Verdict.INTENSIFIED]])
def test_a_lesson_that_says_nothing_is_dropped_and_counted(said: str) -> None:
    ledger = Ledger()
    script = ScriptedChat(lambda _: json.dumps({"lesson": said}))
    assert reflect(PromptedModel(script, Prompts(), ledger), LEARNT, 2) == LEARNT
    counts = ledger.close_step(0.0)[0]
    assert (counts["lessons_dropped"], counts["fallbacks"]) == (2, 0)
    reflect(PromptedModel(ScriptedChat(teacher), Prompts(), ledger), LEARNT, 2)
    assert "lessons_dropped" not in ledger.close_step(0.0)[0]


def test_a_server_that_does_not_answer_ends_the_episode() -> None:
    chat = ScriptedChat(lambda _: ModelUnavailableError("gone"))
    with pytest.raises(ModelUnavailableError):
        reflect(PromptedModel(chat, Prompts(), Ledger()), LEARNT, 9)


def test_a_lesson_of_the_models_is_stored_and_counted(junction: Junction, tmp_path: Path) -> None:
    path = tmp_path / "m.sqlite"
    model = Scripted(ScriptedChat(teacher))
    made = CoDriving(CdaLevel(**{**FULL, "safety_check": False}), model, online(path, reflection="llm"), 1.5)
    episode = drive(junction.environment, made, 10_001)
    assert episode.outcome is not None
    counts, lines = made.conclude(episode.worlds[-1], episode.outcome)
    mistakes = [k.experience for k in open_snapshot(path, FeatureEmbedder()).experiences]
    taught = [e for e in mistakes if e.lesson.endswith("Yield earlier.")]
    assert len(taught) >= 1
    assert counts["model_calls"] == len(lines) >= len(taught)
    assert {line["purpose"] for line in lines} == {"reflect"}


def test_without_a_model_no_lessons_are_written(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"memory\.reflection=llm needs a language model"):
        CoDriving(CdaLevel(**FULL), Offline(), online(tmp_path / "m.sqlite", reflection="llm"), 1.5)
