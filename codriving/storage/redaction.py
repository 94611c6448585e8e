"""Keeps secrets out of what is written: values under names that sound like one are masked."""

import json
import re
from collections.abc import Mapping

MASK = "<redacted>"
_SECRET = re.compile(r"key|token|secret|password|credential", re.IGNORECASE)
# These hold the *name* of a variable, which is no secret and is needed to repeat the run.
_NAME_OF_VARIABLE = re.compile(r"(_env|_variable)$", re.IGNORECASE)


def redact(settings: Mapping[str, object]) -> dict[str, object]:
    """Mask secrets in a resolved config.

    Numbers, switches and null stay: ``max_tokens: 500`` gives nothing away.

    Args:
        settings: Resolved config of plain values.

    Returns:
        A copy without secrets.
    """
    return {name: _mask(name, value) for name, value in settings.items()}


def _mask(name: str, value: object) -> object:
    if isinstance(value, Mapping):
        return {inner: _mask(str(inner), item) for inner, item in value.items()}
    if isinstance(value, list | tuple):
        return [_mask(name, item) for item in value]
    if isinstance(value, str) and value and _SECRET.search(name) and not _NAME_OF_VARIABLE.search(name):
        return MASK
    return value


def flat(settings: Mapping[str, object], prefix: str = "") -> dict[str, str]:
    """Write nested settings as ``scenario.cavs -> 4``, so that two runs can be compared key by key.

    Args:
        settings: Nested plain values.
        prefix: What to put before each name.

    Returns:
        JSON of each value, by dotted key.
    """
    pairs: dict[str, str] = {}
    for name, value in settings.items():
        if isinstance(value, Mapping) and value:
            pairs |= flat(value, f"{prefix}{name}.")
        else:
            pairs[f"{prefix}{name}"] = json.dumps(value, ensure_ascii=False, default=str)
    return pairs


def nested(pairs: Mapping[str, str]) -> dict[str, object]:
    """Undo ``flat``.

    Args:
        pairs: JSON of each value, by dotted key.

    Returns:
        Nested plain values; what was masked stays masked.

    Raises:
        ValueError: If a value is not JSON.
    """
    settings: dict[str, object] = {}
    for key, text in pairs.items():
        *above, last = key.split(".")
        node = settings
        for name in above:
            inner = node.setdefault(name, {})
            if not isinstance(inner, dict):
                raise ValueError(f"{key} lies below a value")
            node = inner
        node[last] = json.loads(text)
    return settings
