"""The arguments that several commands share."""

from pathlib import Path
from typing import Annotated

import typer

from codriving.cli.completion import complete_in_line

Overrides = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="[KEY=VALUE]...",
        help="Settings, for instance scenario=intersection, episodes=50 or cda.negotiation=false.",
        autocompletion=complete_in_line,
    ),
]

ConfigDir = Annotated[
    Path | None,
    typer.Option("--config-dir", metavar="DIR", help="A folder with YAML files of your own, in the same groups."),
]

ShowConfig = Annotated[bool, typer.Option("--cfg", help="Print the composed config and run nothing.")]
