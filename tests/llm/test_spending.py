"""Spending is added up and stopped in time, with what to do."""

from concurrent.futures import ThreadPoolExecutor

import pytest

from codriving.errors import ConfigError, SpendingLimitError
from codriving.llm.spending import Spending, Totals


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


@pytest.mark.parametrize("key", ["max_cost", "max_tokens_total"])
@pytest.mark.parametrize("limit", [0, -1, float("nan")])
def test_a_limit_that_lets_nothing_pass_is_refused(key: str, limit: float) -> None:
    with pytest.raises(ConfigError, match=rf"llm\.{key} must be above 0"):
        Spending(**{key: limit})  # type: ignore[arg-type]


def test_threads_share_it() -> None:
    spending = Spending()
    with ThreadPoolExecutor(8) as pool:
        list(pool.map(lambda k: spending.add(k, 1, 0.25), range(1000)))
    assert spending.totals() == Totals(1000, 499_500, 1000, 250.0)
