"""A language model as methods use it: with its templates, and with the ledger in which its answers are counted."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from codriving.datatypes.parts import CaseMemory, Model
from codriving.errors import ConfigError
from codriving.llm.ledger import Ledger
from codriving.llm.prompts.render import Prompts, load_prompts, template_files
from codriving.llm.question import Answer, Chat, Question


@dataclass(frozen=True)
class PromptedModel:
    """A model, its templates, and where its answers are noted."""

    chat: Chat
    prompts: Prompts
    ledger: Ledger

    def ask(self, questions: Sequence[Question]) -> list[Answer]:
        """Ask all questions at once, and note the answers.

        Raises:
            ModelUnavailableError: If the model does not answer.
            SpendingLimitError: If the tokens or the money that may be spent are used up.
        """
        answers = self.chat.ask(questions) if questions else []
        for question, answer in zip(questions, answers, strict=True):
            self.ledger.note(question, answer)
        return answers


def prompted(llm: Model) -> PromptedModel | None:
    """Return the model of an episode, with an empty ledger; None for the built-in rules."""
    chat = llm.chat()
    return None if chat is None else PromptedModel(chat, load_prompts(llm.prompts), Ledger())


def check_model(llm: Model, memory: CaseMemory | None) -> None:
    """Try the templates out, so that a broken one is found before anything is driven.

    Raises:
        ConfigError: If a template cannot be used, or a memory wants a model to reflect and there is none.
    """
    if llm.prompts is not None:
        load_prompts(llm.prompts)
    if memory is not None and memory.reflections and llm.chat() is None:
        raise ConfigError("memory.reflection=llm needs a language model; set llm= to one, or memory.reflection=rules")


def prompt_files(llm: Model, memory: CaseMemory | None, asked: Sequence[str], reflect: str) -> dict[str, Path]:
    """Return the templates with which a model is asked; none where the built-in rules reason.

    Args:
        asked: Purposes of the questions of every episode.
        reflect: Purpose of the questions on mistakes, if the memory asks any.
    """
    if llm.chat() is None:
        return {}
    return template_files(llm.prompts, (*asked, *([reflect] if memory is not None and memory.reflections else [])))
