"""The rows of controls: which take part below the methods, and ``controls=false``, which leaves them out."""

from collections.abc import Sequence
from pathlib import Path

from codriving.config import ABLATION, CONTROLS, Point, choices, taking_part, values
from codriving.errors import ConfigError


def split_controls(overrides: Sequence[str], usual: bool) -> tuple[bool, list[str]]:
    """Take ``controls=`` out of the tokens.

    Args:
        usual: Whether controls take part if it is not given.
    """
    own = [token for token in overrides if token.lstrip("+").partition("=")[0] == CONTROLS]
    given = own[-1].partition("=")[2].lower() if own else str(usual).lower()
    if given not in ("true", "false"):
        raise ConfigError(f"controls must be true or false, got {given!r:.100}")
    return given == "true", [token for token in overrides if token not in own]


def ablation_controls(point: Point, reference: str, config_dir: Path | None = None) -> list[Point]:
    """Give the controls with which the ablation of a config is compared, in the settings of that config.

    Args:
        reference: The method that controls are variants of; no others have any.
    """
    keys = [token.lstrip("+").partition("=")[0] for token in point.overrides]
    chosen = [t.partition("=")[2] for t, key in zip(point.overrides, keys, strict=True) if key == "method"]
    if chosen and chosen[-1] != reference:
        return []
    found, files = [], choices("method", config_dir)
    for name in taking_part(ABLATION):
        # Settings of the method hold for a control that has them, too.
        known = {f"method.{key}" for key in values(files[name])}
        kept = [t for t, key in zip(point.overrides, keys, strict=True) if not _of_method(key) or key in known]
        found.append(Point((*kept, f"method={name}"), point.swept, (f"method={name}",)))
    return found


def _of_method(key: str) -> bool:
    return key.partition(".")[0] == "method"
