"""Who stands behind the two ports, Coordinator and Decider: the built-in rules, or a language model."""

from typing import TYPE_CHECKING, Protocol

from codriving.reasoning.decision.decider import Decider
from codriving.reasoning.decision.rules import RuleDecider
from codriving.reasoning.ordering.coordinator import Coordinator, RuleCoordinator

if TYPE_CHECKING:
    from codriving.llm.ledger import Ledger
    from codriving.llm.question import Chat


class Reasoner(Protocol):
    """Who reasons. A language model also has ``prompts`` (a folder or None) and ``ask_plain``.

    Attributes:
        name: Name for tables: ``rules``, or that of a model.
    """

    name: str

    def chat(self) -> "Chat | None":
        """Return the model to ask, or None for the built-in rules."""
        ...


def check_prompts(llm: Reasoner) -> None:
    """Try the templates out, so that a broken one is found before anything is driven.

    Raises:
        ConfigError: If a template cannot be used.
    """
    folder = getattr(llm, "prompts", None)
    if folder is not None:
        from codriving.llm.prompts.render import load_prompts

        load_prompts(folder)


def ports(llm: Reasoner, binding: bool, sees_conflicts: bool) -> "tuple[Coordinator, Decider, Ledger | None]":
    """Return who negotiates, who decides, and where answers are noted."""
    chat = llm.chat()
    if chat is None:
        return RuleCoordinator(binding), RuleDecider(), None
    # pydantic and Jinja2 are needed only if a model is asked.
    from codriving.llm.ledger import Ledger
    from codriving.llm.prompts.render import load_prompts
    from codriving.methods.language_model.model_coordinator import ModelCoordinator
    from codriving.methods.language_model.model_decider import ModelDecider

    prompts, ledger = load_prompts(getattr(llm, "prompts", None)), Ledger()
    coordinator = ModelCoordinator(chat, prompts, ledger, binding)
    ask_plain = bool(getattr(llm, "ask_plain", False))
    return coordinator, ModelDecider(chat, prompts, ledger, ask_plain, sees_conflicts), ledger
