"""A composed config as text for people, and as a fingerprint for run folders."""

import hashlib
import json
from collections.abc import Mapping, Sequence
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
    """Write a composed config as YAML, in the order in which it was composed."""
    from omegaconf import OmegaConf

    return OmegaConf.to_yaml(OmegaConf.create(dict(resolved)))


def fingerprint(resolved: Mapping[str, Any]) -> str:
    """Reduce a composed config to what its results depend on.

    Returns:
        The SHA-256 of its canonical JSON, without the keys that have no effect on results.
    """
    text = json.dumps(relevant(resolved), sort_keys=True, separators=(",", ":"), ensure_ascii=True, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()


SNAPSHOT, AUTO = "snapshot", "auto"
"""Where a memory's snapshot is told by its contents, its file may lie anywhere."""


def relevant(resolved: Mapping[str, Any]) -> dict[str, Any]:
    """Leave out what has no effect on results.

    Returns:
        A copy; what other nodes hold of ``llm`` and ``memory`` is left out likewise.
    """
    dropped: list[tuple[object, Sequence[str]]] = [(resolved.get("llm"), HOW_A_MODEL_IS_ASKED)]
    memory = resolved.get("memory")
    if isinstance(memory, Mapping) and memory.get(SNAPSHOT, AUTO) != AUTO:
        dropped.append((memory, ("file", "embedding_deadline")))
    return {key: _without(value, dropped) for key, value in resolved.items() if key not in WITHOUT_EFFECT}


def _without(node: Any, dropped: Sequence[tuple[object, Sequence[str]]]) -> Any:  # noqa: ANN401 - any plain value
    """A node without some keys of some nodes, wherever these stand in it."""
    if not isinstance(node, Mapping):
        return [_without(value, dropped) for value in node] if isinstance(node, list) else node
    keys = {key for wanted, names in dropped if node == wanted for key in names}
    return {key: _without(value, dropped) for key, value in node.items() if key not in keys}
