"""What a language model has cost so far, and whether it may cost more."""

import threading
from dataclasses import dataclass

from codriving.errors import ConfigError, SpendingLimitError

_RESUME = "go on"


@dataclass(frozen=True, slots=True)
class Totals:
    """What has been used up; answers from the cache are free and not in it.

    Attributes:
        cost: Money [USD]; None if the price of a call is not known.
    """

    calls: int = 0
    prompt_tokens: int = 0
    completion_tokens: int = 0
    cost: float | None = 0.0

    @property
    def tokens(self) -> int:
        """Tokens of prompts and answers together."""
        return self.prompt_tokens + self.completion_tokens


class Spending:
    """Adds up tokens and money; any number of threads may share it.

    Calls that are under way when a limit is reached are still answered and paid for, so that it may be passed by as
    many of them as there are at once.

    Args:
        max_cost: Money that may be spent [USD]; None for any.
        max_tokens_total: Tokens of prompts and answers that may be used; None for any.

    Raises:
        ConfigError: If a limit is not above 0.
    """

    def __init__(self, max_cost: float | None = None, max_tokens_total: int | None = None) -> None:
        for key, limit in (("max_cost", max_cost), ("max_tokens_total", max_tokens_total)):
            if limit is not None and not limit > 0:
                raise ConfigError(f"llm.{key} must be above 0, or null for no limit, got {limit:g}")
        self.max_cost, self.max_tokens_total = max_cost, max_tokens_total
        self._totals = Totals()
        self._lock = threading.Lock()

    def check(self) -> None:
        """Let another call pass, or not.

        Raises:
            SpendingLimitError: If what may be spent is used up, or cannot be told.
        """
        spent = self.totals()
        if self.max_tokens_total is not None and spent.tokens >= self.max_tokens_total:
            raise SpendingLimitError(
                f"llm.max_tokens_total={self.max_tokens_total} is used up ({spent.tokens} tokens in {spent.calls} "
                f"calls); raise llm.max_tokens_total and {_RESUME}"
            )
        if self.max_cost is None:
            return
        if spent.cost is None:
            raise SpendingLimitError(
                f"llm.max_cost={self.max_cost:g} cannot be kept, because the price of this model is not known; set "
                "llm.input_cost_per_token and llm.output_cost_per_token, or llm.max_tokens_total instead of "
                f"llm.max_cost, and {_RESUME}"
            )
        if spent.cost >= self.max_cost:
            raise SpendingLimitError(
                f"llm.max_cost={self.max_cost:g} USD is used up ({spent.cost:.6g} USD, {spent.tokens} tokens in "
                f"{spent.calls} calls); raise llm.max_cost and {_RESUME}"
            )

    def add(self, prompt_tokens: int, completion_tokens: int, cost: float | None) -> None:
        """Add a call that was answered.

        Args:
            cost: What it cost [USD]; None where no price is known.
        """
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
        with self._lock:
            return self._totals
