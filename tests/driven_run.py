"""A short run of its own for tests of what reads finished runs."""

from pathlib import Path

from codriving.commands.run import run_experiment


def driven_run(output: Path, *tokens: str) -> Path:
    """Drive in one process, and give the run folder."""
    assert run_experiment([f"output={output}", "run=first", "launcher=serial", *tokens]) == 0
    return output / "run" / "first"
