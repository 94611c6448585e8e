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
    from codriving.config.choices import ALL, SWEPT, check_config_dir, choices, describe

    if config_dir is not None:
        check_config_dir(config_dir)
    if group is not None and group not in PLURALS and group not in PLURALS.values():
        raise ConfigError(f"unknown group {group!r}; choices: {', '.join(PLURALS)}")
    for plural, singular in PLURALS.items():
        found = choices(singular, config_dir)
        several = singular in SWEPT and len(found) > 1
        if group in (plural, singular):
            for name, file in found.items():
                print(f"{name:<20} {describe(file)}".rstrip())
            if several:
                print(f"{ALL:<20} Every one of these, in this order: one row of the table each.")
        elif group is None:
            print(f"{plural:<20} {', '.join([*found, *([f'or {ALL}'] if several else [])]) or '-'}")
