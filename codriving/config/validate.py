"""Everything a config describes is built once before anything runs: a mistake costs a line and not an hour."""

from collections.abc import Mapping
from typing import Any

from codriving.config.build import build
from codriving.config.schema import check_root
from codriving.datatypes.parts import CaseMemory, Method, Metric, Model, Scenario, Simulator

EXPECTED: dict[str, type] = {
    "scenario": Scenario,
    "executor": object,
    "cda": object,
    "llm": Model,
    "memory": CaseMemory,
    "metrics": Metric,
    "launcher": object,
    "environment": Simulator,
}
"""What each node has to be; those of a room further up are checked again where a method or a run takes them."""


def validate(resolved: Mapping[str, Any]) -> None:
    """Check keys, types and ranges of every node by building it, and last the method, which refers to others.

    Raises:
        ConfigError: With the full key, the rule and the value that broke it.
    """
    check_root(resolved)
    plugins = resolved["plugins"]
    made: dict[str, Any] = {
        name: build(resolved[name], expected, name, plugins)
        for name, expected in EXPECTED.items()
        if resolved[name] is not None
    }
    build(resolved["method"], Method, "method", plugins, {Model: made["llm"], CaseMemory: made.get("memory")})
