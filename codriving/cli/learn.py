"""`codriving learn`: success against the number of past interactions."""

import typer

from codriving.cli.arguments import ConfigDir, Overrides, ShowConfig


def learn(overrides: Overrides = None, config_dir: ConfigDir = None, cfg: ShowConfig = False) -> None:
    """Learn from so many interactions, then test what was learnt: success after each, as table and figure.

    interactions=0,2,5,10,20 says after how many; scenario=all and three CDA levels are tested unless you name some.
    The same command with the same run=NAME goes on where it was interrupted.
    """
    from codriving.experiment.learn import run_learn

    raise typer.Exit(run_learn(overrides or [], config_dir, cfg))
