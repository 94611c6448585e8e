"""Prices of the config come before those that LiteLLM knows, and what nobody knows is not free."""

import sys
from types import ModuleType

import pytest

from codriving.llm.prices import cost_of

LISTED = {
    "gpt-4o-mini": {"litellm_provider": "openai", "input_cost_per_token": 2.0, "output_cost_per_token": 8.0},
    "ollama/llama3": {"litellm_provider": "ollama", "input_cost_per_token": 0.0, "output_cost_per_token": 0.0},
    "spoken": {"litellm_provider": "openai", "input_cost_per_second": 1.0},
}


@pytest.fixture
def listed(monkeypatch: pytest.MonkeyPatch) -> None:
    module = ModuleType("litellm")
    module.model_cost = LISTED  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "litellm", module)


@pytest.mark.usefixtures("listed")
def test_listed_prices_are_used_where_the_config_has_none() -> None:
    assert cost_of("gpt-4o-mini", 10, 1) == 28.0
    assert cost_of("openai/gpt-4o-mini", 10, 1) == 28.0
    assert cost_of("ollama/llama3", 10, 1) == 0.0
    assert cost_of("gpt-4o-mini", 10, 1, input_price=1.0) == 18.0
    assert cost_of("gpt-4o-mini", 10, 1, output_price=1.0) == 21.0


@pytest.mark.usefixtures("listed")
@pytest.mark.parametrize("model", ["my-own", "openai/my-own", "hosted_vllm/gpt-4o-mini", "spoken", "openai/"])
def test_what_is_not_listed_is_not_known(model: str) -> None:
    assert cost_of(model, 10, 1) is None
    assert cost_of(model, 10, 1, input_price=1.0) is None
    assert cost_of(model, 10, 1, 1.0, 2.0) == 12.0


def test_litellm_is_never_imported_for_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "litellm", raising=False)
    assert cost_of("gpt-4o-mini", 10, 1) is None
    assert "litellm" not in sys.modules
