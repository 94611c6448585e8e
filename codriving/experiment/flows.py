"""What a run of flows has to be: by a method and a metric that are fit for it, and not mixed with episodes."""

from collections.abc import Mapping, Sequence
from typing import Any

from codriving.datatypes import CaseMemory, Method, Metric
from codriving.errors import ConfigError


def is_flow(resolved: Mapping[str, Any]) -> bool:
    """Tell whether a config drives flows."""
    return resolved.get("flow") is not None


def check_flow(resolved: Mapping[str, Any], method: Method, metric: Metric, memory: CaseMemory | None) -> None:
    """Refuse a flow that a part of the config is not made for."""
    if not is_flow(resolved):
        return
    if method.most_cavs is not None:
        raise ConfigError(
            f"method {method.name!r} decides for {method.most_cavs} CAVs at most, and in a flow there may be any "
            "number; choose another method or order, or flow=none"
        )
    if not metric.flows:
        raise ConfigError(
            f"metrics {metric.name!r} measures episodes and no flows; leave metrics out, or flow (a class of yours "
            "that measures flows says so with flows = True)"
        )
    if memory is not None and memory.learns:
        raise ConfigError(
            "a flow neither succeeds nor fails, so that nothing is learnt in it; leave flow out where memory=online "
            "learns, as in codriving learn and codriving memory build"
        )


def refuse_mixed(configs: Sequence[Mapping[str, Any]]) -> None:
    """Refuse flows and episodes in one table."""
    if len({is_flow(config) for config in configs}) > 1:
        raise ConfigError(
            "flows and episodes have different tables; give flow=none and flow=steady a command of their own each"
        )
