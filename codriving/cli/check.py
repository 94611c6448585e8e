"""`codriving check`: whether a language model answers as it should."""

import typer

from codriving.cli.arguments import ConfigDir, Overrides


def check(overrides: Overrides = None, config_dir: ConfigDir = None) -> None:
    """Ask a language model for one order and one decision, and show answer, form, latency, tokens and cost.

    Exit code 0 if both were answered in form, 1 if a fallback was needed, 2 if the model cannot be reached.
    """
    from codriving.experiment import run_check

    raise typer.Exit(run_check(overrides or [], config_dir))
