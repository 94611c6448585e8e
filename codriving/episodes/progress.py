"""How far a batch is: a bar on a terminal, a few plain lines in a pipe."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol, TextIO


class Progress(Protocol):
    """Somebody who is told of each unit that has ended."""

    def update(self, done: int, failed: int) -> None:
        """Take note.

        Args:
            done: Units that have ended, failed ones included.
            failed: Units that ended in an error.
        """
        ...


class Silent:
    """Nobody wants to know."""

    def update(self, done: int, failed: int) -> None:
        """Do nothing."""


class _Lines:
    """About ten lines a batch, for logs."""

    def __init__(self, total: int, stream: TextIO) -> None:
        self._total = total
        self._stream = stream
        self._every = max(1, total // 10)

    def update(self, done: int, failed: int) -> None:
        if done % self._every == 0 or done == self._total:
            print(f"{done} of {self._total} episodes done, {failed} failed", file=self._stream, flush=True)


@contextmanager
def show_progress(total: int, stream: TextIO | None = None) -> Iterator[Progress]:
    """Show how far a batch is while the block lasts.

    Args:
        total: Number of units.
        stream: Where to show it; standard error by default, so that a pipe gets the table alone.

    Yields:
        Whom to tell.
    """
    stream = stream or sys.stderr
    if not stream.isatty():
        yield _Lines(total, stream)
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    columns = (
        TextColumn("episodes"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[failed]} failed"),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
    )
    with Bar(*columns, console=Console(file=stream)) as bar:
        task = bar.add_task("episodes", total=total, failed=0)

        class _Bar:
            def update(self, done: int, failed: int) -> None:
                bar.update(task, completed=done, failed=failed)

        yield _Bar()
