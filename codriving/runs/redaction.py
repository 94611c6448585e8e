"""Keeps secrets out of what is written: values under names that sound like one are masked."""

import json
import os
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from codriving.runs.json_files import parse_json

MASK = "<redacted>"
_SECRET = re.compile(r"key|token|secret|password|credential", re.IGNORECASE)
# These hold the *name* of a variable, which is no secret and is needed to repeat the run.
_NAME_OF_VARIABLE = re.compile(r"(_env|_variable)$", re.IGNORECASE)
_VARIABLE = re.compile(r"[A-Z_][A-Z0-9_]*")
# Names of fields and headers are no secrets; of the further fields of a request few are: not ``tokenizer``.
_PLAIN, _FIELDS = ("max_tokens_field", "api_key_header"), "extra"
_SECRET_FIELD = re.compile(r".*(key|token|secret|password|credential)s?", re.IGNORECASE)

# A value of fewer characters is no secret but a stand-in such as EMPTY, and would take whole words out of texts.
SHORTEST = 8


def redact(settings: Mapping[str, object]) -> dict[str, object]:
    """Mask secrets in a resolved config.

    Numbers, switches and null stay: ``max_tokens: 500`` gives nothing away.
    """
    return {name: _mask(name, value) for name, value in settings.items()}


def _mask(name: str, value: object, within: bool = False) -> object:
    """Mask a value; within the fields of a request only what may be a key in length and name."""
    if isinstance(value, Mapping):
        within = within or name == _FIELDS
        return {key: item if key in _PLAIN else _mask(str(key), item, within) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_mask(name, item, within) for item in value]
    if not isinstance(value, str) or not value or not _SECRET.search(name):
        return value
    if within and (len(value) < SHORTEST or not _SECRET_FIELD.fullmatch(name)):
        return value
    return value if _NAME_OF_VARIABLE.search(name) and _VARIABLE.fullmatch(value) else MASK


def variables_in(settings: object) -> tuple[str, ...]:
    """List the environment variables that hold secrets, as a resolved config names them."""
    return tuple(dict.fromkeys(_variables(settings)))


def _variables(node: object) -> Iterator[str]:
    if isinstance(node, list | tuple):
        node = dict(enumerate(node))
    for name, value in node.items() if isinstance(node, Mapping) else ():
        if isinstance(value, str) and value and _NAME_OF_VARIABLE.search(str(name)):
            yield value
        else:
            yield from _variables(value)


def secrets_of(variables: Iterable[str]) -> tuple[str, ...]:
    """Read the secrets that environment variables hold at this moment, the longest first."""
    values = {os.environ.get(name, "").strip() for name in variables}
    return tuple(sorted((value for value in values if len(value) >= SHORTEST), key=len, reverse=True))


def suspects() -> tuple[str, ...]:
    """List the environment variables that may hold secrets by their names, whatever the config says."""
    return tuple(name for name in os.environ if _SECRET.search(name))


def scrubbed(value: Any, secrets: Iterable[str]) -> Any:  # noqa: ANN401 - any plain value
    """Take secrets out of every text of plain values, wherever they came from."""
    if isinstance(value, str):
        for secret in secrets:
            value = value.replace(secret, MASK)
        return value
    if isinstance(value, Mapping):
        return {name: scrubbed(item, secrets) for name, item in value.items()}
    return [scrubbed(item, secrets) for item in value] if isinstance(value, list | tuple) else value


def flat(settings: Mapping[str, object], prefix: str = "") -> dict[str, str]:
    """Write nested settings as ``scenario.cavs -> 4``, so that two runs can be compared key by key.

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
        node[last] = parse_json(text)
    return settings
