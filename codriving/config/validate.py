"""Everything a config describes is built once before anything runs: a mistake costs a line and not an hour."""

from collections.abc import Mapping
from typing import Any

from codriving.config.build import build
from codriving.config.schema import NODES, check_root

ORDER = (*(name for name in NODES if name != "method"), "method")
"""The method comes last: what it refers to (cda, llm, memory) is then blamed under its own name."""


def validate(resolved: Mapping[str, Any]) -> None:
    """Check keys, types and ranges of every node by building it.

    Raises:
        ConfigError: With the full key, the rule and the value that broke it.
    """
    check_root(resolved)
    for name in ORDER:
        if resolved[name] is not None:
            build(resolved[name], resolved["plugins"], name)
