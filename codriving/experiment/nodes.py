"""Config nodes of plain values: whether one stands somewhere in another, and what it looks like with one replaced."""

from collections.abc import Mapping
from typing import Any


def holds(node: object, wanted: object) -> bool:
    """Tell whether a config node is what is wanted or has it somewhere inside."""
    if node == wanted:
        return True
    if isinstance(node, Mapping):
        return any(holds(value, wanted) for value in node.values())
    return isinstance(node, list) and any(holds(value, wanted) for value in node)


def replaced(node: Any, old: object, new: Any) -> Any:  # noqa: ANN401 - any plain value
    """Return a config node with something in it replaced, wherever it stands."""
    if node == old:
        return new
    if isinstance(node, Mapping):
        return {key: replaced(value, old, new) for key, value in node.items()}
    return [replaced(value, old, new) for value in node] if isinstance(node, list) else node
