"""Who stands behind the two ports, Coordinator and Decider: the built-in rules, or a language model."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from codriving.datatypes.parts import CaseMemory, Model
from codriving.reasoning.decision.rules import Decider, RuleDecider
from codriving.reasoning.ordering.coordinator import Coordinator, RuleCoordinator

if TYPE_CHECKING:
    from codriving.llm.ledger import Ledger


def prompt_files(llm: Model, memory: CaseMemory | None, asked: Sequence[str], reflect: str) -> dict[str, Path]:
    """Return the templates with which a model is asked; none where the built-in rules reason.

    Args:
        asked: Purposes of the questions of every episode.
        reflect: Purpose of the questions on mistakes, if the memory asks any.
    """
    if llm.chat() is None:
        return {}
    from codriving.llm.prompts.render import template_files

    return template_files(llm.prompts, (*asked, *([reflect] if memory is not None and memory.reflections else [])))


def check_prompts(llm: Model) -> None:
    """Try the templates out, so that a broken one is found before anything is driven.

    Raises:
        ConfigError: If a template cannot be used.
    """
    if llm.prompts is not None:
        from codriving.llm.prompts.render import load_prompts

        load_prompts(llm.prompts)


def ports(llm: Model, binding: bool, sees_conflicts: bool) -> "tuple[Coordinator, Decider, Ledger | None]":
    """Return who negotiates, who decides, and where answers are noted."""
    chat = llm.chat()
    if chat is None:
        return RuleCoordinator(binding), RuleDecider(), None
    # pydantic and Jinja2 are needed only if a model is asked.
    from codriving.llm.ledger import Ledger
    from codriving.llm.prompts.render import load_prompts
    from codriving.methods.language_model.model_coordinator import ModelCoordinator
    from codriving.methods.language_model.model_decider import ModelDecider

    prompts, ledger = load_prompts(llm.prompts), Ledger()
    coordinator = ModelCoordinator(chat, prompts, ledger, binding)
    return coordinator, ModelDecider(chat, prompts, ledger, llm.ask_plain, sees_conflicts), ledger
