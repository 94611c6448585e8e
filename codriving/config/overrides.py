"""What the command line says, made ready for Hydra: groups stay groups, every key is judged by our own rules."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from codriving.config.choices import LISTED, choices
from codriving.config.schema import GROUPS, ROOT
from codriving.errors import ConfigError

KEY_VALUE = "write key=value, for instance scenario=intersection or episodes=20"


def prepare(tokens: Sequence[str], config_dir: Path | None = None) -> list[str]:
    """Turn override tokens into overrides that Hydra composes without judging keys.

    Hydra refuses an unknown key unless it has a ``+``, and then accepts any. So every key gets its ``++`` here, and the
    checks after composing refuse what nobody reads: one rule and one message for both spellings.

    Args:
        tokens: ``key=value`` as typed.
        config_dir: The user's own configs, if any.

    Returns:
        The overrides for Hydra, in the same order.

    Raises:
        ConfigError: If a token is not ``key=value``, or names a choice that there is not.
    """
    return [_prepare(token, config_dir) for token in tokens]


def _prepare(token: str, config_dir: Path | None) -> str:
    override = _parse(token)
    key = override.key_or_group
    if override.is_delete():
        raise ConfigError(f"{token}: keys cannot be removed, only set; {KEY_VALUE}")
    if override.package is not None or key == "hydra" or key.startswith(("hydra.", "hydra/")):
        raise ConfigError(f"{token}: Hydra's own settings and packages are not used here; {KEY_VALUE}")
    if override.is_sweep_override():
        raise ConfigError(f"{token}: a key takes one value; for a text with commas write {key}='\"a,b\"'")
    plain = token.lstrip("+")
    if key in LISTED:
        _check_choice(key, override.value(), config_dir)
        return plain
    if "/" in key:
        return plain
    head, _, rest = key.partition(".")
    slot = rest.partition(".")[0]
    if head not in GROUPS[2:] and slot in GROUPS:
        raise ConfigError(f"{key} is {slot} itself; set {rest} instead")
    if key in ROOT and ROOT[key].kind is str and not isinstance(override.value(), str | None):
        # Hydra reads run=2026_01 as a number; a name stays what was typed.
        return f"++{key}='{plain.partition('=')[2]}'"
    return f"++{plain}"


def _parse(token: str) -> Any:  # noqa: ANN401 - Hydra's own class, which is not typed
    from hydra.core.override_parser.overrides_parser import OverridesParser
    from hydra.errors import HydraException

    try:
        return OverridesParser.create().parse_override(token)
    except HydraException as err:
        reason = str(err.__cause__ or err).splitlines()[0]
        raise ConfigError(f"cannot read {token!r} ({reason}); {KEY_VALUE}") from err


def _check_choice(group: str, value: object, config_dir: Path | None) -> None:
    known = choices(group, config_dir)
    if value is None and group == "experiments":
        return
    if isinstance(value, list | dict):
        raise ConfigError(f"{group} takes one name, got {value!r}; choices: {', '.join(known) or 'none'}")
    if str(value) not in known:
        raise ConfigError(f"unknown {group} {str(value)!r}; choices: {', '.join(known) or 'none'}")
