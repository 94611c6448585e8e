"""Rules between keys that no single object sees, checked right after composing."""

from collections.abc import Mapping
from typing import Any

from codriving.config.schema import LARGEST_SEED
from codriving.config.secrets import check_secrets
from codriving.errors import ConfigError


def check_rules(resolved: Mapping[str, Any]) -> None:
    """Check what no single key can be blamed for.

    Rules between the keys of one node are its constructor's.

    Raises:
        ConfigError: If two settings contradict each other, or one holds a secret.
    """
    check_secrets(resolved)
    last = resolved["seed"] + resolved["episodes"] - 1
    if last > LARGEST_SEED:
        raise ConfigError(f"seed + episodes - 1 must be at most {LARGEST_SEED}, got {last}; lower seed or episodes")
    if resolved["launcher"]["_target_"] == SERIAL and resolved["workers"] not in ("auto", 1):
        raise ConfigError(f"workers must be auto or 1 with launcher=serial, got {resolved['workers']}")


SERIAL = "codriving.experiment.launchers.Serial"
"""The launcher that has no other process than this one."""
