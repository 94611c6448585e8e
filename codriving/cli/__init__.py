"""The command line: no logic, and the only door to Typer."""

from codriving.cli.app import main

__all__ = ["main"]
