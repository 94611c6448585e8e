"""How far a batch is: a bar on a terminal, a few plain lines in a pipe."""

import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Protocol, TextIO


class Progress(Protocol):
    """Somebody who is told of each unit that has ended."""

    def update(self, cell: str, failed: bool) -> None:
        """Take note."""
        ...


class Silent:
    """Nobody wants to know."""

    def update(self, cell: str, failed: bool) -> None:
        """Do nothing."""


class _Count:
    """Units and cells that have ended."""

    def __init__(self, units: Mapping[str, int]) -> None:
        self._left = dict(units)
        self.total = sum(units.values())
        self.done = self.failed = 0

    def add(self, cell: str, failed: bool) -> None:
        """Count one unit."""
        self._left[cell] -= 1
        self.done += 1
        self.failed += failed

    @property
    def cells(self) -> str:
        """How many cells are complete, where there are several."""
        complete = sum(left == 0 for left in self._left.values())
        return f"{complete} of {len(self._left)} cells" if len(self._left) > 1 else ""


class _Lines:
    """About ten lines a batch, for logs."""

    def __init__(self, count: _Count, stream: TextIO, note: Callable[[], str] | None) -> None:
        self._count, self._stream, self._note = count, stream, note
        self._every = max(1, count.total // 10)

    def update(self, cell: str, failed: bool) -> None:
        count = self._count
        count.add(cell, failed)
        if count.done % self._every == 0 or count.done == count.total:
            cells = f", {count.cells} complete" if count.cells else ""
            note = f"; {self._note()}" if self._note else ""
            text = f"{count.done} of {count.total} episodes done, {count.failed} failed{cells}{note}"
            print(text, file=self._stream, flush=True)


@contextmanager
def show_progress(
    units: Mapping[str, int], stream: TextIO | None = None, note: Callable[[], str] | None = None
) -> Iterator[Progress]:
    """Show how far a batch is while the block lasts."""
    stream = stream or sys.stderr
    count = _Count(units)
    if not stream.isatty():
        yield _Lines(count, stream, note)
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        ProgressColumn,
        Task,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )
    from rich.progress import Progress as Bar
    from rich.text import Text

    class _Note(ProgressColumn):
        """Asked anew each time that the bar is drawn, so that it moves between two episodes too."""

        def render(self, task: Task) -> Text:
            return Text(note() if note else "")

    columns = (
        TextColumn("episodes"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[failed]} failed"),
        *([TextColumn("{task.fields[cells]}")] if count.cells else []),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        *([_Note()] if note else []),
    )
    with Bar(*columns, console=Console(file=stream)) as bar:
        task = bar.add_task("episodes", total=count.total, failed=0, cells=count.cells)

        class _Bar:
            def update(self, cell: str, failed: bool) -> None:
                count.add(cell, failed)
                bar.update(task, completed=count.done, failed=count.failed, cells=count.cells)

        yield _Bar()
