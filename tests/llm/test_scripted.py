"""A scripted chat is read like a model."""

import pytest
from fake_sender import GOOD, Choice, question

from codriving.errors import ModelUnavailableError
from codriving.llm.question import Question
from codriving.llm.scripted import ScriptedChat


def test_objects_and_words_are_answers() -> None:
    for said in (Choice(reason="free", action="IDLE"), f"Well: {GOOD}"):
        chat = ScriptedChat(lambda asked, said=said: said)
        (answer,) = chat.ask([question()])
        assert answer.value == Choice(reason="free", action="IDLE")
        assert (chat.calls, chat.rounds) == (1, 1)


def test_script_is_called_again_with_the_complaint() -> None:
    def script(asked: Question) -> str:
        return GOOD if "cannot be used" in asked.messages[-1].content else "no"

    chat = ScriptedChat(script)
    answers = chat.ask([question(), question()])
    assert all(answer.value is not None and answer.asked_again for answer in answers)
    assert (chat.calls, chat.rounds) == (4, 1)


def test_exceptions_are_raised() -> None:
    chat = ScriptedChat(lambda asked: ModelUnavailableError("gone"), name="x")
    with pytest.raises(ModelUnavailableError, match="gone"):
        chat.ask([question()])
    assert chat.name == "x"
