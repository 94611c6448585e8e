"""What the command line says, made ready for Hydra: groups stay groups, every key is judged by our own rules."""

import re
from pathlib import Path
from typing import Any

from codriving.config.choices import LISTED, choices
from codriving.config.schema import GROUPS, ROOT
from codriving.errors import ConfigError

KEY_VALUE = "write key=value, for instance scenario=intersection or episodes=20"

TEXT_WITH_COMMAS = "for a text with commas write {key}='\"a,b\"'"

_SECRET = re.compile(r"key|token|secret|password|credential", re.IGNORECASE)


def prepare(token: str, config_dir: Path | None = None) -> str:
    """Turn an override into one that Hydra composes without judging its key.

    Hydra refuses an unknown key unless it has a ``+``, and then accepts any. So every key gets its ``++`` here, and the
    checks after composing refuse what is not read: one rule and one message for both spellings.
    """
    override = parse(token)
    key = override.key_or_group
    if override.is_delete():
        raise ConfigError(f"{shown(token)}: keys cannot be removed, only set; {KEY_VALUE}")
    if override.package is not None or key == "hydra" or key.startswith(("hydra.", "hydra/")):
        raise ConfigError(f"{shown(token)}: Hydra's own settings and packages are not used here; {KEY_VALUE}")
    if override.is_sweep_override():
        hint = "" if key in LISTED else f"; {TEXT_WITH_COMMAS.format(key=key)}"
        raise ConfigError(f"{shown(token)}: {key} takes one value here{hint}")
    plain = token.lstrip("+")
    if key in LISTED:
        check_choice(key, override.value(), config_dir)
    if key in LISTED or "/" in key:
        return plain
    head, _, rest = key.partition(".")
    if head not in GROUPS[2:] and (slot := rest.partition(".")[0]) in GROUPS:
        raise ConfigError(f"{key} is {slot} itself; set {rest} instead")
    if key in ROOT and ROOT[key].kind is str and not isinstance(override.value(), str | None):
        # Hydra reads run=2026_01 as a number; a name stays what was typed.
        return f"++{key}='{plain.partition('=')[2]}'"
    return f"++{plain}"


def shown(token: str) -> str:
    """Give an override for a message."""
    return f"{token.partition('=')[0]}=..." if may_be_secret(token) else token


def may_be_secret(token: str) -> bool:
    """Tell whether an override may hold a secret, by the name of its key."""
    return _SECRET.search(token.partition("=")[0]) is not None


def parse(token: str) -> Any:  # noqa: ANN401 - Hydra's own class, which is not typed
    """Read one override with Hydra's grammar.

    Args:
        token: ``key=value`` as typed.

    Returns:
        Hydra's ``Override``.

    Raises:
        ConfigError: If it is not one.
    """
    from hydra.core.override_parser.overrides_parser import OverridesParser
    from hydra.errors import HydraException

    try:
        return OverridesParser.create().parse_override(token)
    except HydraException as err:
        said = [str(error) for error in (err.__cause__, err) if error is not None and str(error) not in ("", "None")]
        # What the parser would have expected instead is its whole alphabet.
        reason = said[0].splitlines()[0].partition(" expecting ")[0] if said else "it has no form known here"
        if may_be_secret(token):
            raise ConfigError(f"cannot read {shown(token)!r}; {KEY_VALUE}") from None
        raise ConfigError(f"cannot read {token!r} ({reason}); {KEY_VALUE}") from err


def check_choice(group: str, value: object, config_dir: Path | None = None) -> None:
    """Refuse what is not the name of a YAML file of a group.

    Raises:
        ConfigError: With the choices that there are.
    """
    known = choices(group, config_dir)
    if value is None and group == "experiments":
        return
    if isinstance(value, list | dict):
        raise ConfigError(f"{group} takes names without brackets, got {value!r}; choices: {', '.join(known) or 'none'}")
    if str(value) not in known:
        raise ConfigError(f"unknown {group} {str(value)!r}; choices: {', '.join(known) or 'none'}")
