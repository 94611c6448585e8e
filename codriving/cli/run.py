"""`codriving run`: a seeded batch of episodes."""

import typer

from codriving.cli.arguments import ConfigDir, Overrides, ShowConfig


def run(overrides: Overrides = None, config_dir: ConfigDir = None, cfg: ShowConfig = False) -> None:
    """Drive a seeded batch of episodes and print its table.

    The same command with the same run=NAME goes on where it was interrupted.
    """
    from codriving.experiment.run import RUN, run_command

    raise typer.Exit(run_command(RUN, overrides or [], config_dir, cfg))
