"""What stands behind the two ports, Coordinator and Decider: the built-in rules, or a language model."""

from codriving.methods.language_model.prompted_model import PromptedModel
from codriving.reasoning.decision.rules import Decider, RuleDecider
from codriving.reasoning.ordering.coordinator import Coordinator, RuleCoordinator


def ports(
    model: PromptedModel | None, ask_plain: bool, binding: bool, sees_conflicts: bool
) -> tuple[Coordinator, Decider]:
    """Return what negotiates and what decides.

    Args:
        model: The language model; None for the built-in rules.
    """
    if model is None:
        return RuleCoordinator(binding), RuleDecider()
    # pydantic is needed only if a model is asked.
    from codriving.methods.language_model.model_coordinator import ModelCoordinator
    from codriving.methods.language_model.model_decider import CheckedDecider

    return ModelCoordinator(model, binding), CheckedDecider(model, ask_plain, sees_conflicts)
