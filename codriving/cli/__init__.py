"""The command line, without logic. The only room that imports Typer."""

from codriving.cli.app import main

__all__ = ["main"]
