"""What the command line says, made ready for Hydra: groups stay groups, every key is judged by our own rules."""

import os
import re
import shlex
from collections.abc import Iterable
from pathlib import Path
from typing import Any
from unicodedata import digit

from codriving.config.choices import LISTED, SUITE, choices
from codriving.config.schema import GROUPS, ROOT, SHOWN, looks_secret, value_shown
from codriving.config.suites import members, suite_sets
from codriving.errors import ConfigError

KEY_VALUE = "write key=value, for instance scenario=intersection or episodes=20"

TEXT_WITH_COMMAS = "for a text with commas write {key}='\"a,b\"'"

_KEY = re.compile(r"\+{0,2}[A-Za-z_][\w./@:-]*", re.ASCII)
_HOME = re.compile(r"(?s)\A([^=]*=)(~(?:/.*)?)\Z")

_SECRET = re.compile(r"key|token|secret|password|credential|llm\.(extra|headers)", re.IGNORECASE)


def prepare(token: str, config_dir: Path | None = None) -> str:
    """Turn an override into one that Hydra composes without judging its key.

    Hydra refuses an unknown key unless it has a ``+``, and then accepts any. So every key gets its ``++`` here, and the
    checks after composing refuse what is not read: one rule and one message for both spellings.
    """
    (token,) = written([token])
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
        # Hydra wants the name of a choice as a text.
        return f"{key}='{choice_named(override.value())}'" if isinstance(override.value(), bool) else plain
    head, _, rest = key.partition(".")
    if head == "method" and rest in SHOWN:
        raise ConfigError(f"{key} is no setting of a run, but what a YAML says for tables; leave it out")
    if head == SUITE:
        raise ConfigError(f"{key}: a suite has no keys of its own, it chooses other groups; set theirs")
    # How long an order takes is no order.
    if key != "thinking.order" and head not in GROUPS[2:] and (slot := rest.partition(".")[0]) in GROUPS:
        if slot == "drivers":
            rest = f"drivers=simulator {rest}"
        why = "has moved in release 0.2" if slot == "drivers" else f"is {slot} itself"
        raise ConfigError(f"{key} {why}; set {rest} instead")
    if key in ROOT and ROOT[key].kind is str and not isinstance(override.value(), str | None):
        # Hydra reads run=2026_01 as a number; a name stays what was typed.
        return f"++{key}='{plain.partition('=')[2]}'"
    return f"++{plain}"


def shown(token: str) -> str:
    """Give an override for a message."""
    return f"{token.partition('=')[0]}=..." if may_be_secret(token) else token


def may_be_secret(token: str) -> bool:
    """Tell whether an override may hold a secret, by the name of its key or the look of its value."""
    key, _, value = token.partition("=")
    return _SECRET.search(key) is not None or looks_secret(value)


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

    (token,) = written([token])
    try:
        return OverridesParser.create().parse_override(token)
    except Exception:  # Hydra's own, and what its parser raises on nests too deep and numbers too long
        pass
    # Outside the handler: what the parser says is its whole alphabet, and may quote a secret.
    key, equals, value = token.partition("=")
    if may_be_secret(token) or not equals or not _KEY.fullmatch(key):
        raise ConfigError(f"cannot read {shown(token)!r:.200}; {KEY_VALUE}")
    if not _reads(f"{key}=0"):
        raise ConfigError(f"cannot read {token!r:.200}: {key:.100} is not the name of a key; {KEY_VALUE}")
    if value.startswith("="):
        raise ConfigError(f"cannot read {token!r:.200}; write {key}={value.lstrip('=') or '<value>'}")
    if any(not part.strip() for part in value.split(",")) and value and value[0] not in "[{(\"'":
        raise ConfigError(f"cannot read {token!r:.200}: a value is missing beside a comma; several are {key}=a,b")
    if value.isdigit() and not value.isascii():
        digits = "".join(str(digit(character)) for character in value[:20])
        raise ConfigError(f"cannot read {token!r:.200}; numbers are written with the digits 0 to 9: {key}={digits}")
    quoted = value.replace("\\", "\\\\").replace('"', '\\"')
    text = f'"{quoted}"'
    if value and value[0] not in "[{(\"'" and _reads(f"{key}={text}") == value:
        raise ConfigError(
            f"cannot read {token!r}: a text with other characters than letters of a to z, digits and _-./:@%+ is "
            f"quoted; write {key}={shlex.quote(text)}"
        )
    raise ConfigError(
        f"cannot read {token!r:.200}: its value has brackets or quotes that do not match, nests too deep or is too "
        f"long; {KEY_VALUE}"
    )


def _reads(token: str) -> object:
    """Read a token that was made up; gives its value, None if it has none."""
    from hydra.core.override_parser.overrides_parser import OverridesParser

    try:
        return str(OverridesParser.create().parse_override(token).value()) if len(token) < 300 else None
    except Exception:
        return None


def written(tokens: Iterable[object]) -> list[str]:
    """Check that overrides were written as such, and read ``~`` as the home folder.

    Raises:
        ConfigError: If one is no text, or a key and its value stand apart.
    """
    found: list[str] = []
    for token in tokens:
        if not isinstance(token, str):
            raise ConfigError(
                f'a setting is a text such as "episodes=5", and each is an argument of its own; got {token!r:.100}'
            )
        if "\0" in token or any("\ud800" <= character <= "\udfff" for character in token):
            raise ConfigError(f"{token!a:.200} holds what is no text, so that no file could hold it; leave it out")
        found.append(token)
    for index, token in enumerate(found):
        key, equals, value = token.partition("=")
        if value or not _KEY.fullmatch(key.lstrip("+")):
            continue
        after = [text for text in found[index + 1 : index + 3] if text != "="][:1]
        given = after[0].removeprefix("=") if after and "=" not in after[0].removeprefix("=") else ""
        if equals and not given:
            continue  # An empty text, which some keys take
        if may_be_secret(key):
            given = ""
        if not given and not equals and ":" in key:
            raise ConfigError(
                f"{key} is no setting; write key and value with a sign between: {key.replace(':', '=', 1)}"
            )
        raise ConfigError(f"{key} stands alone; write key and value without blanks: {key}={given or '<value>'}")
    return [_HOME.sub(_at_home, token) for token in found]


def _at_home(match: "re.Match[str]") -> str:
    path = at_home(match[2]).replace("\\", "\\\\").replace("'", "\\'")
    return f"{match[1]}'{path}'"


def at_home(text: str) -> str:
    """Read ``~`` at the beginning of a path as the home folder."""
    if text != "~" and not text.startswith("~/"):
        return text
    path = os.path.expanduser(text)  # noqa: PTH111 - a text, since a Path drops what may matter
    if path.startswith("~"):
        raise ConfigError(f"{text} is below the home folder, and there is none; set HOME, or write the path in full")
    return path


def choice_named(value: object) -> str:
    """Return the name of a choice; ``true`` and ``false`` are names like others."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def check_choice(group: str, value: object, config_dir: Path | None = None) -> None:
    """Refuse what is not the name of a YAML file of a group.

    Raises:
        ConfigError: With the choices that there are.
    """
    known = choices(group, config_dir)
    if value is None and group == "experiments":
        return
    if isinstance(value, list | dict):
        raise ConfigError(
            f"{group} takes names without brackets, got {value_shown(value)}; choices: {', '.join(known) or 'none'}"
        )
    if group == SUITE and str(value) in (sets := suite_sets(config_dir)):
        raise ConfigError(
            f"{SUITE}={value} is a set of suites, {sets[str(value)].name}, and one is asked for here; name one of it: "
            f"{', '.join(member.suite for member in members(str(value), config_dir))}"
        )
    if choice_named(value) not in known:
        several = [*known, *(suite_sets(config_dir) if group == SUITE else ())]
        raise ConfigError(f"unknown {group} {value_shown(str(value))}; choices: {', '.join(several) or 'none'}")
