"""Spending is added up and stopped in time, with what to do; prices come from the config or from LiteLLM."""

import sys
from concurrent.futures import ThreadPoolExecutor
from types import ModuleType

import pytest

from codriving.errors import SpendingLimitError
from codriving.llm.spending import Spending, Totals, cost_of


def test_without_limits_everything_passes() -> None:
    spending = Spending()
    spending.add(10**9, 10**9, 1e6)
    spending.check()
    assert spending.totals() == Totals(1, 10**9, 10**9, 1e6)
    assert spending.totals().tokens == 2 * 10**9


def test_tokens_of_prompts_and_answers_count() -> None:
    spending = Spending(max_tokens_total=100)
    spending.add(60, 39, None)
    spending.check()
    spending.add(1, 0, None)
    with pytest.raises(SpendingLimitError) as caught:
        spending.check()
    text = str(caught.value)
    assert text.startswith("llm.max_tokens_total=100 is used up (100 tokens in 2 calls); raise llm.max_tokens_total")
    assert text.endswith("and go on")
    assert "\n" not in text


def test_money_counts() -> None:
    spending = Spending(max_cost=0.5)
    spending.add(10, 10, 0.3)
    spending.check()
    spending.add(10, 10, 0.2)
    with pytest.raises(SpendingLimitError, match=r"llm\.max_cost=0\.5 USD is used up \(0\.5 USD, 40 tokens in 2 calls"):
        spending.check()


def test_money_that_cannot_be_told_is_not_spent() -> None:
    spending = Spending(max_cost=0.5)
    spending.check()
    spending.add(10, 10, None)
    spending.add(10, 10, 0.1)
    assert spending.totals().cost is None
    with pytest.raises(SpendingLimitError, match=r"price of this model is not known; set llm\.input_cost_per_token"):
        spending.check()


def test_threads_share_it() -> None:
    spending = Spending()
    with ThreadPoolExecutor(8) as pool:
        list(pool.map(lambda k: spending.add(k, 1, 0.25), range(1000)))
    assert spending.totals() == Totals(1000, 499_500, 1000, 250.0)


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
