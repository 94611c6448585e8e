"""The command line: one command a file, no logic, and the only door to Typer."""
