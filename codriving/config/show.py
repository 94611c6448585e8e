"""A composed config as text for people, and as a fingerprint for run folders."""

import hashlib
import json
from collections.abc import Mapping
from typing import Any

WITHOUT_EFFECT = ("episodes", "workers", "output", "run", "launcher", "render", "prompts")
"""Keys that change how much of a run is made, where and how fast, never what an episode is; prompts are in `llm`."""

HOW_A_MODEL_IS_ASKED = (
    "api_key_env",
    "attempts",
    "cache",
    "cache_file",
    "deadline",
    "failures_in_a_row",
    "max_concurrency",
    "max_cost",
    "max_tokens_total",
)
"""Keys of ``llm`` likewise: with them a run goes on after a limit has been raised, or is replayed under its name."""


def show(resolved: Mapping[str, Any]) -> str:
    """Write a composed config as YAML, in the order in which it was composed.

    Args:
        resolved: The composed config as a plain dict.

    Returns:
        The YAML, with a newline at the end.
    """
    from omegaconf import OmegaConf

    return OmegaConf.to_yaml(OmegaConf.create(dict(resolved)))


def fingerprint(resolved: Mapping[str, Any]) -> str:
    """Reduce a composed config to what its results depend on.

    Args:
        resolved: The composed config as a plain dict.

    Returns:
        The SHA-256 of its canonical JSON, without the keys that have no effect on results.
    """
    text = json.dumps(relevant(resolved), sort_keys=True, separators=(",", ":"), ensure_ascii=True, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()


def relevant(resolved: Mapping[str, Any]) -> dict[str, Any]:
    """Leave out what has no effect on results.

    Args:
        resolved: The composed config as a plain dict.

    Returns:
        A copy; what other nodes hold of ``llm`` is left out likewise.
    """
    model = resolved.get("llm")
    return {key: _without(value, model) for key, value in resolved.items() if key not in WITHOUT_EFFECT}


def _without(node: Any, model: object) -> Any:  # noqa: ANN401 - any plain value
    """A node without the settings of how a model is asked, wherever the model stands in it."""
    if not isinstance(node, Mapping):
        return [_without(value, model) for value in node] if isinstance(node, list) else node
    dropped = HOW_A_MODEL_IS_ASKED if node == model else ()
    return {key: _without(value, model) for key, value in node.items() if key not in dropped}
