"""Who stands behind the two ports."""

from pathlib import Path

import pytest
from asked import Scripted, sensible

from codriving.errors import ConfigError
from codriving.llm.language_model import Offline
from codriving.llm.scripted import ScriptedChat
from codriving.methods.language_model.model_coordinator import ModelCoordinator
from codriving.methods.language_model.model_decider import ModelDecider
from codriving.methods.language_model.ports import check_prompts, ports
from codriving.reasoning.decision.rules import RuleDecider
from codriving.reasoning.ordering.coordinator import RuleCoordinator


def test_rules_stand_there_without_a_model() -> None:
    coordinator, decider, ledger = ports(Offline(), True, True)
    assert isinstance(coordinator, RuleCoordinator)
    assert coordinator.binding
    assert isinstance(decider, RuleDecider)
    assert ledger is None


def test_model_stands_behind_both_with_one_ledger() -> None:
    model = Scripted(ScriptedChat(sensible), ask_plain=True)
    coordinator, decider, ledger = ports(model, True, False)
    assert isinstance(coordinator, ModelCoordinator)
    assert isinstance(decider, ModelDecider)
    assert coordinator.chat is decider.chat is model.scripted
    assert coordinator.ledger is decider.ledger is ledger
    assert coordinator.rules.binding
    assert decider.ask_plain
    assert not decider.sees_conflicts


def test_broken_templates_are_found_before_anything_is_driven(tmp_path: Path) -> None:
    check_prompts(Offline())
    check_prompts(Scripted(ScriptedChat(sensible)))
    (tmp_path / "negotiate.user.md.j2").write_text("{{ pears }}")
    with pytest.raises(ConfigError, match="no variable 'pears'; there are binding, fixed, pairs, vehicles"):
        check_prompts(Scripted(ScriptedChat(sensible), prompts=str(tmp_path)))
