"""Who stands behind DiLu's two ports, Thinker and Reflector: a rule, or a language model."""

from typing import TYPE_CHECKING

from codriving.methods.dilu.reflection import Reflector, RuleReflector
from codriving.methods.dilu.rule_thinker import RuleThinker
from codriving.methods.dilu.thinker import Thinker
from codriving.methods.single_vehicle.method import Driver

if TYPE_CHECKING:
    from codriving.llm.ledger import Ledger
    from codriving.llm.question import Chat


def dilu_ports(
    chat: "Chat | None", prompts: str | None, rule: Driver, interval: float
) -> "tuple[Thinker, Reflector, Ledger | None]":
    """Return who reasons, who reflects, and where answers are noted.

    Args:
        chat: The model; None for the rule.
        prompts: Folder with templates that replace ours; None takes ours.
        interval: Time between two decisions of a CAV [s].
    """
    if chat is None:
        return RuleThinker(rule), RuleReflector(), None
    # pydantic and Jinja2 are needed only if a model is asked.
    from codriving.llm.ledger import Ledger
    from codriving.llm.prompts.render import load_prompts
    from codriving.methods.dilu.model_reflector import ModelReflector
    from codriving.methods.dilu.model_thinker import ModelThinker

    templates, ledger = load_prompts(prompts), Ledger()
    return ModelThinker(chat, templates, ledger, interval), ModelReflector(chat, templates, ledger), ledger
