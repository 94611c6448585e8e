"""`codriving run`: a seeded batch of episodes."""

import typer

from codriving.cli.arguments import ConfigDir, Overrides, ShowConfig


def run(overrides: Overrides = None, config_dir: ConfigDir = None, cfg: ShowConfig = False) -> None:
    """Drive a seeded batch of episodes and print its table.

    The same command with the same run=NAME goes on where it was interrupted.
    """
    if cfg:
        from codriving.cli.config_page import print_configs
        from codriving.config.sweep import expand

        print_configs(expand(overrides or [], config_dir), config_dir)
        return
    from codriving.experiment import run_experiment

    raise typer.Exit(run_experiment(overrides or [], config_dir))
