"""What stands behind the two ports."""

from pathlib import Path

import pytest
from asked import Scripted, sensible

from codriving.errors import ConfigError
from codriving.llm.language_model import Offline
from codriving.llm.scripted import ScriptedChat
from codriving.methods.codriving import ports
from codriving.methods.language_model.model_coordinator import ModelCoordinator
from codriving.methods.language_model.model_decider import CheckedDecider
from codriving.methods.language_model.prompted_model import check_model, prompted
from codriving.reasoning.decision.rules import RuleDecider
from codriving.reasoning.ordering.coordinator import RuleCoordinator


def test_rules_stand_there_without_a_model() -> None:
    coordinator, decider = ports(prompted(Offline()), True, True, True)
    assert isinstance(coordinator, RuleCoordinator)
    assert coordinator.binding
    assert isinstance(decider, RuleDecider)


def test_model_stands_behind_both_with_one_ledger() -> None:
    chat = ScriptedChat(sensible)
    model = prompted(Scripted(chat))
    assert model is not None
    coordinator, decider = ports(model, True, True, False)
    assert isinstance(coordinator, ModelCoordinator)
    assert isinstance(decider, CheckedDecider)
    assert coordinator.model is decider.model is model
    assert model.chat is chat
    assert coordinator.rules.binding
    assert decider.ask_plain
    assert not decider.sees_conflicts


def test_broken_templates_are_found_before_anything_is_driven(tmp_path: Path) -> None:
    check_model(Offline(), None)
    check_model(Scripted(ScriptedChat(sensible)), None)
    (tmp_path / "negotiate.user.md.j2").write_text("{{ pears }}")
    with pytest.raises(
        ConfigError, match="no variable 'pears'; there are binding, everyone, fixed, humans, norms, pairs"
    ):
        check_model(Scripted(ScriptedChat(sensible), prompts=str(tmp_path)), None)
