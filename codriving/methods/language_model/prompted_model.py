"""A language model as methods use it: with its templates, and with the ledger in which its answers are counted."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from codriving.datatypes import Account, CaseMemory, DrivingModel, Method, Model, Road, RuleModel
from codriving.errors import ConfigError
from codriving.geometry import RoadMap
from codriving.llm import Answer, Chat, Ledger, Question

if TYPE_CHECKING:
    from codriving.llm import Prompts


@dataclass(frozen=True)
class PromptedModel:
    """A model, its templates, and where its answers are noted."""

    chat: Chat
    prompts: "Prompts"
    ledger: Ledger
    thoughts: bool = False  # Whether it writes its thoughts down before it answers

    def ask(self, questions: Sequence[Question]) -> list[Answer]:
        """Ask all questions at once, and note the answers."""
        marked = [replace(question, occasion=self.ledger.occasion()) for question in questions]
        answers = self.chat.ask(marked) if marked else []
        for question, answer in zip(questions, answers, strict=True):
            self.ledger.note(question, answer)
        return answers


def prompted(llm: Model, seed: int = 0) -> PromptedModel | None:
    """Return the model of an episode, with an empty ledger; None for the built-in rules."""
    if (chat := llm.chat()) is None:
        return None
    from codriving.llm import load_prompts

    return PromptedModel(chat, load_prompts(llm.prompts), Ledger(seed), llm.thoughts)


def reasons_by(llm: Model) -> str:
    """Return what reasons, for tables: the rules, or a model with the prompts by which it is asked."""
    if isinstance(llm, RuleModel):
        return llm.name
    from codriving.llm import prompts_name

    return f"{llm.name} ({prompts_name(llm.prompts)})"


def check_model(llm: Model, memory: CaseMemory | None) -> None:
    """Try the templates out, so that a broken one is found before anything is driven."""
    if llm.prompts is not None:
        from codriving.llm import load_prompts

        load_prompts(llm.prompts)
    if memory is not None and memory.reflections and llm.chat() is None:
        raise ConfigError("memory.reflection=llm needs a language model; set llm= to one, or memory.reflection=rules")


class ModelMethod(Method):
    """A method that reasons by a language model or by rules in its place, and may remember."""

    asked: tuple[str, ...]  # Purposes of the questions of every episode
    reflects: ClassVar[str]  # Purpose of the questions on mistakes, if the memory asks any

    def __init__(self, llm: Model, memory: CaseMemory | None) -> None:
        check_model(llm, memory)
        self.llm, self.memory, self.reasoner = llm, memory, llm.name
        self.remembers = memory.label if memory is not None else ""

    def files(self, road: Road, limited: bool) -> Mapping[str, Path]:
        """Return the files of a model and the templates that it is asked with; none where the built-in rules reason."""
        if self.llm.chat() is None:
            return {}
        from codriving.llm import template_files

        asked = (*self.asked, self.reflects) if self.corrects() else self.asked
        return {**self.llm.files(), **template_files(self.llm.prompts, asked)}

    def corrects(self) -> bool:
        """Whether a model is asked about mistakes after an episode."""
        return self.memory is not None and self.memory.reflections > 0

    def reset(self, road_map: RoadMap, model: DrivingModel, seed: int) -> None:
        """Begin an episode."""
        self._model = prompted(self.llm, seed)

    def unfinished_step(self, time: float) -> Account:
        return self._model.ledger.close_step(time) if self._model is not None else ({}, [])
