"""`codriving compare`: the paper's comparison tables."""

from typing import Annotated

import typer

from codriving.cli.arguments import ConfigDir, Overrides, ShowConfig
from codriving.cli.completion import complete_table


def compare(
    table: Annotated[
        str | None,
        typer.Argument(
            metavar="TABLE", help="Which table: baselines, single-vehicle, all or load.", autocompletion=complete_table
        ),
    ] = None,
    overrides: Overrides = None,
    config_dir: ConfigDir = None,
    cfg: ShowConfig = False,
) -> None:
    """Drive every method of the paper on the same seeds, into one table beside the paper's.

    baselines: each method against codriving. single-vehicle: those by which each CAV is on its own. all: both.
    load: baselines with 4, 6, 8 and 12 CAVs. method=NAME adds a method of your own.
    """
    from codriving import experiment

    raise typer.Exit(experiment.run_command(experiment.compare(table), overrides or [], config_dir, cfg))
