"""`codriving ablate`: the reasoning module with each sub-module removed in turn."""

import typer

from codriving.cli.arguments import ConfigDir, Overrides, ShowConfig


def ablate(overrides: Overrides = None, config_dir: ConfigDir = None, cfg: ShowConfig = False) -> None:
    """Run the full method and each reasoning sub-module removed, on the same seeds, into one table."""
    from codriving.experiment.run import ABLATE, run_command

    raise typer.Exit(run_command(ABLATE, overrides or [], config_dir, cfg))
