"""Keys of language models are given by the name of an environment variable; one that was typed instead is not shown."""

import re
from collections.abc import Iterator, Mapping
from typing import Any

from codriving.errors import ConfigError

_VARIABLE = re.compile(r"[A-Z_][A-Z0-9_]*")
_SECRET = re.compile(r"key|token|secret|password|credential", re.IGNORECASE)
_PASSWORD = re.compile(r"\w+://[^/]*@")


def check_secrets(resolved: Mapping[str, Any]) -> None:
    """Refuse what may be a key where the name of its variable belongs; the message leaves the value out.

    Raises:
        ConfigError: If a setting that ends in ``_env`` is not the name of a variable, or an address has a password.
    """
    for key, value in sorted(texts(resolved), key=lambda pair: pair[0].count(".")):
        if key.endswith("_env") and not _VARIABLE.fullmatch(value):
            raise ConfigError(
                f"{key} must be the name of an environment variable (capitals, digits and _) that holds the key, not "
                f"the key itself; what was given is not shown: set the variable and give its name, {key}=MY_KEY"
            )
        if _PASSWORD.match(value):
            raise ConfigError(
                f"{key} must be an address without user and password, for it is written to the run folder; what was "
                "given is not shown"
            )


def shown(token: str) -> str:
    """Give an override for a message.

    Args:
        token: ``key=value`` as typed.
    """
    return f"{token.partition('=')[0]}=..." if may_be_secret(token) else token


def may_be_secret(token: str) -> bool:
    """Tell whether an override may hold a secret, by the name of its key.

    Args:
        token: ``key=value`` as typed.
    """
    return _SECRET.search(token.partition("=")[0]) is not None


def texts(node: object, key: str = "") -> Iterator[tuple[str, str]]:
    """Yield every text with its dotted key."""
    if isinstance(node, Mapping):
        for name, value in node.items():
            yield from texts(value, f"{key}.{name}" if key else str(name))
    elif isinstance(node, list):
        for index, value in enumerate(node):
            yield from texts(value, f"{key}.{index}")
    elif isinstance(node, str):
        yield key, node
