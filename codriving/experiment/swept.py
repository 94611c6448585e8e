"""What tells the rows of a sweep apart: the swept keys that scenario, method, variant and reasoner do not show."""

import json
from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Any

from codriving.config.choices import LISTED
from codriving.experiment.episodes.unit import Labels
from codriving.runs.redaction import redact

_LABELS = {"scenario": "scenario", "method": "method"}
_LABELS_BELOW = {"cda": "variant", "method": "variant", "llm": "reasoner"}
"""The label in which a group, or a key of it, may show."""


def swept_values(swept: Mapping[str, str], resolved: Mapping[str, Any]) -> dict[str, str]:
    """Read off a config what stands in it for the keys that were given several values."""
    plain = redact(resolved)
    return {key: typed if key in LISTED else _value(plain, key, typed) for key, typed in swept.items()}


def _value(node: object, key: str, typed: str) -> str:
    for part in key.split("."):
        if isinstance(node, Mapping) and part in node:
            node = node[part]
        elif isinstance(node, list) and part.isdigit() and int(part) < len(node):
            node = node[int(part)]
        else:
            return typed
    return node if isinstance(node, str) else json.dumps(node, ensure_ascii=False)


def shown_apart(cells: Sequence[tuple[Labels, Mapping[str, str]]]) -> list[dict[str, str]]:
    """Keep of the swept keys those that need a column of their own.

    Returns:
        The values of these keys for each cell, by the head of their column.
    """
    keys = list(dict.fromkeys(key for _, swept in cells for key in swept))
    kept = [key for key in keys if _needs_column(key, cells)]
    return [{_head(key): swept[key] for key in kept if key in swept} for _, swept in cells]


def _needs_column(key: str, cells: Sequence[tuple[Labels, Mapping[str, str]]]) -> bool:
    if len({swept.get(key) for _, swept in cells}) == 1:
        return False
    label = _LABELS.get(key) or _LABELS_BELOW.get(key.partition(".")[0])
    if label is None:
        return True
    values = defaultdict(set)
    for labels, swept in cells:
        values[getattr(labels, label)].add(swept.get(key))
    return any(len(several) > 1 for several in values.values())


def _head(key: str) -> str:
    """A choice of scenario may have the name of another one: two files for one class."""
    return f"{key}_choice" if key in _LABELS else key
