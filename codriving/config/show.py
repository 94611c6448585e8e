"""A composed config as text for people, and as a fingerprint for run folders."""

import hashlib
import json
from collections.abc import Mapping
from typing import Any

WITHOUT_EFFECT = ("episodes", "workers", "output", "run", "launcher", "render")
"""Keys that change how much of a run is made, where and how fast, never what an episode is."""


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
    relevant = {key: value for key, value in resolved.items() if key not in WITHOUT_EFFECT}
    text = json.dumps(relevant, sort_keys=True, separators=(",", ":"), ensure_ascii=True, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()
