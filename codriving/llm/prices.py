"""What a call costs: the prices of the config, else those that LiteLLM knows, else nobody knows."""

import sys
from collections.abc import Mapping
from typing import Any

INPUT, OUTPUT = "input_cost_per_token", "output_cost_per_token"
"""What LiteLLM's price map calls the two prices [USD/token]; the keys of the config are called alike."""


def cost_of(
    model: str,
    prompt_tokens: int,
    completion_tokens: int,
    input_price: float | None = None,
    output_price: float | None = None,
) -> float | None:
    """Work out what a call costs.

    Args:
        input_price: Price of the prompt by the config [USD/token]; None where it has none.
        output_price: Price of the answer by the config [USD/token]; None where it has none.

    Returns:
        The cost [USD]; None where a price is not known.
    """
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
