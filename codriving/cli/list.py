"""`codriving list`: what can be chosen."""

from typing import Annotated

import typer

from codriving.cli.arguments import ConfigDir
from codriving.cli.completion import PLURALS, complete_group
from codriving.errors import ConfigError


def list_choices(
    group: Annotated[
        str | None,
        typer.Argument(metavar="[GROUP]", help=f"One of {', '.join(PLURALS)}.", autocompletion=complete_group),
    ] = None,
    config_dir: ConfigDir = None,
) -> None:
    """List what a group offers, or all groups."""
    from codriving.config.choices import check_config_dir, choices, describe

    if config_dir is not None:
        check_config_dir(config_dir)
    if group is not None and group not in PLURALS and group not in PLURALS.values():
        raise ConfigError(f"unknown group {group!r}; choices: {', '.join(PLURALS)}")
    for plural, singular in PLURALS.items():
        if group in (plural, singular):
            for name, file in choices(singular, config_dir).items():
                print(f"{name:<20} {describe(file)}".rstrip())
        elif group is None:
            print(f"{plural:<20} {', '.join(choices(singular, config_dir)) or '-'}")
