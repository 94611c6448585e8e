"""How far a training is: a bar with the last validation on a terminal, a line a validation in a pipe."""

import sys
from collections.abc import Mapping
from typing import Any, Self, TextIO

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from codriving.training.curve import SUCCESS


class Display:
    """Tells how far a training is."""

    def __init__(self, name: str, total: int, stream: TextIO | None = None) -> None:
        self._console = Console(file=stream or sys.stderr, highlight=False, soft_wrap=True)
        self._total = total
        columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
        self._bar = Progress(*columns, TextColumn("{task.fields[note]}"), console=self._console)
        self._task = self._bar.add_task(name, total=total, note="")

    def __enter__(self) -> Self:
        if self._console.is_terminal:
            self._bar.start()
        return self

    def __exit__(self, *raised: object) -> None:
        self._bar.stop()

    def advance(self, decisions: int) -> None:
        """Tell how many decisions have been driven."""
        self._bar.update(self._task, completed=min(decisions, self._total))

    def note(self, text: str) -> None:
        """Say something in a line of its own."""
        self._console.print(text, markup=False)

    def validated(self, row: Mapping[str, Any]) -> None:
        """Tell what a validation said."""
        self._bar.update(self._task, note=f"success {row['score']:.0%}")
        more = [f"{name} {row[name]:.4g}" for name in ("epsilon", "loss", "pull") if row.get(name) is not None]
        self.note(", ".join([f"{row['decisions']:>9} of {self._total} decisions", *more, _said(row)]))

    def final(self, row: Mapping[str, Any]) -> None:
        """Tell what the last validation said of one state."""
        self.note(f"state after {row['decisions']} decisions, on further seeds: {_said(row)}")


def _said(row: Mapping[str, Any]) -> str:
    exams = {name.removesuffix(f".{SUCCESS}"): value for name, value in row.items() if name.endswith(f".{SUCCESS}")}
    return f"success {row['score']:.1%} (" + ", ".join(f"{name} {value:.0%}" for name, value in exams.items()) + ")"
