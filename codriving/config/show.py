"""A composed config as text."""

from collections.abc import Mapping
from typing import Any


def show(resolved: Mapping[str, Any]) -> str:
    """Write a composed config as YAML, in the order in which it was composed."""
    from omegaconf import OmegaConf

    return OmegaConf.to_yaml(OmegaConf.create(dict(resolved)))
