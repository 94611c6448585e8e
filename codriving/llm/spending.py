"""What a language model has cost so far, what a call costs, and whether it may cost more."""

import sys
import threading
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from codriving.errors import SpendingLimitError


@dataclass(frozen=True, slots=True)
class Totals:
    """What has been used up; answers from the cache are free and not in it."""

    calls: int = 0
    prompt_tokens: int = 0
    completion_tokens: int = 0
    cost: float | None = 0.0  # Money [USD]; None if the price of a call is not known

    @property
    def tokens(self) -> int:
        """Tokens of prompts and answers together."""
        return self.prompt_tokens + self.completion_tokens


class Spending:
    """Adds up tokens and money; any number of threads may share it.

    Calls that are under way when a limit is reached are still answered and paid for, so that it may be passed by as
    many of them as there are at once.
    """

    def __init__(self, max_cost: float | None = None, max_tokens_total: int | None = None) -> None:
        self.max_cost, self.max_tokens_total = max_cost, max_tokens_total
        self._totals = Totals()
        self._lock = threading.Lock()

    def check(self) -> None:
        """Let another call pass, or not."""
        spent = self.totals()
        if self.max_tokens_total is not None and spent.tokens >= self.max_tokens_total:
            raise SpendingLimitError(
                f"llm.max_tokens_total={self.max_tokens_total} is used up ({spent.tokens} tokens in {spent.calls} "
                f"calls); raise llm.max_tokens_total and go on"
            )
        if self.max_cost is None:
            return
        if spent.cost is None:
            raise SpendingLimitError(
                f"llm.max_cost={self.max_cost:g} cannot be kept, because the price of this model is not known; set "
                "llm.input_cost_per_token and llm.output_cost_per_token, or llm.max_tokens_total instead of "
                f"llm.max_cost, and go on"
            )
        if spent.cost >= self.max_cost:
            raise SpendingLimitError(
                f"llm.max_cost={self.max_cost:g} USD is used up ({spent.cost:.6g} USD, {spent.tokens} tokens in "
                f"{spent.calls} calls); raise llm.max_cost and go on"
            )

    def add(self, prompt_tokens: int, completion_tokens: int, cost: float | None) -> None:
        """Add a call that was answered."""
        with self._lock:
            past = self._totals
            self._totals = Totals(
                past.calls + 1,
                past.prompt_tokens + prompt_tokens,
                past.completion_tokens + completion_tokens,
                None if cost is None or past.cost is None else past.cost + cost,
            )

    def totals(self) -> Totals:
        """Give what has been used up so far, all of the same moment."""
        return self._totals


# What LiteLLM's price map calls the two prices [USD/token]; the keys of the config are called alike.
INPUT, OUTPUT = "input_cost_per_token", "output_cost_per_token"


def cost_of(
    model: str,
    prompt_tokens: int,
    completion_tokens: int,
    input_price: float | None = None,
    output_price: float | None = None,
) -> float | None:
    """Work out what a call costs."""
    listed = _listed(model) if input_price is None or output_price is None else {}
    first = listed.get(INPUT) if input_price is None else input_price
    second = listed.get(OUTPUT) if output_price is None else output_price
    return None if first is None or second is None else prompt_tokens * first + completion_tokens * second


def _listed(model: str) -> Mapping[str, Any]:
    """What LiteLLM knows of a model; nothing if LiteLLM is not in use, for its import alone takes seconds."""
    prices: Mapping[str, Mapping[str, Any]] = getattr(sys.modules.get("litellm"), "model_cost", {})
    if model in prices:
        return prices[model]
    # "openai/gpt-4o-mini" is listed as "gpt-4o-mini"; a model of that name at another provider costs what that asks.
    provider, _, name = model.partition("/")
    entry = prices.get(name, {})
    return entry if entry.get("litellm_provider") == provider else {}
