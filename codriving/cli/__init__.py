"""The command line: no logic, and the only door to Typer."""
