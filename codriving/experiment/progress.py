"""How far a batch is: a bar on a terminal and in a notebook, a few plain lines in a pipe."""

import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from typing import TextIO, TypeAlias

from codriving.experiment.notebook import notebook, show_bar

Update: TypeAlias = Callable[[str, bool], None]  # Takes note that an episode has ended: its cell, and whether it failed


class _Count:
    """Units and cells that have ended."""

    def __init__(self, units: Mapping[str, int]) -> None:
        self._left, self.total = dict(units), sum(units.values())
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


@contextmanager
def show_progress(
    units: Mapping[str, int], note: Callable[[], str] | None = None, stream: TextIO | None = None
) -> Iterator[Update]:
    """Show how far a batch is while the block lasts."""
    count = _Count(units)
    if stream is None and count.total and (display := notebook()) is not None:
        with show_bar(display, count.total, partial(_said, count, note)) as move:

            def move_on(cell: str, failed: bool) -> None:
                count.add(cell, failed)
                move(count.done)

            yield move_on
        return
    stream = stream or sys.stderr
    if not stream.isatty() or not count.total:
        yield partial(_print_line, count, stream, note)
        return
    from rich import progress
    from rich.console import Console, RenderableType
    from rich.text import Text

    class _Bar(progress.Progress):
        """With the note on a line of its own, read anew each time: it moves between two episodes too."""

        def get_renderables(self) -> Iterable[RenderableType]:
            yield from super().get_renderables()
            if note:
                yield Text(note())

    columns = (
        progress.TextColumn("episodes"),
        progress.BarColumn(),
        progress.MofNCompleteColumn(),
        progress.TextColumn("{task.fields[failed]} failed"),
        *([progress.TextColumn("{task.fields[cells]}")] if count.cells else []),
        progress.TimeElapsedColumn(),
        progress.TextColumn("left"),
        progress.TimeRemainingColumn(),
    )
    with _Bar(*columns, console=Console(file=stream)) as bar:
        task = bar.add_task("episodes", total=count.total, failed=0, cells=count.cells)

        def move_bar(cell: str, failed: bool) -> None:
            count.add(cell, failed)
            bar.update(task, completed=count.done, failed=count.failed, cells=count.cells)

        yield move_bar


def _print_line(count: _Count, stream: TextIO, note: Callable[[], str] | None, cell: str, failed: bool) -> None:
    """Print about ten lines a batch, for logs."""
    count.add(cell, failed)
    if count.done % max(1, count.total // 10) == 0 or count.done == count.total:
        print(_said(count, note), file=stream, flush=True)


def _said(count: _Count, note: Callable[[], str] | None) -> str:
    cells = f", {count.cells} complete" if count.cells else ""
    said = f"; {note()}" if note else ""
    return f"{count.done} of {count.total} episodes done, {count.failed} failed{cells}{said}"
