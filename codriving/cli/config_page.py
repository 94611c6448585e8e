"""What ``--cfg`` prints."""

from collections.abc import Sequence
from pathlib import Path


def print_config(overrides: Sequence[str], config_dir: Path | None) -> None:
    """Print the composed config, once it is known to be valid.

    Args:
        overrides: ``key=value`` tokens.
        config_dir: The user's own configs, if any.

    Raises:
        ConfigError: If the config cannot be used.
    """
    from codriving.config.compose import compose
    from codriving.config.show import show
    from codriving.config.validate import validate

    resolved = compose(overrides, config_dir)
    validate(resolved)
    print(show(resolved), end="")
