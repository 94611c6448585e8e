"""How far a batch is, in a notebook: one line with a bar, drawn anew in its place."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from html import escape
from importlib import import_module
from typing import Any

EVERY = 0.2  # Shortest time between two drawings [s]; each is a message to the browser


def notebook() -> Any | None:  # noqa: ANN401 - a module that need not be installed
    """Return what shows things in the notebook that runs this process; None outside of one."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return import_module("IPython.display") if getattr(shell, "kernel", None) is not None else None


@contextmanager
def show_bar(display: Any, total: int, said: Callable[[], str]) -> Iterator[Callable[[int], None]]:  # noqa: ANN401
    """Show a bar while the block lasts; it is given how many episodes are done.

    Args:
        said: Gives what stands behind the bar.
    """
    begun = time.monotonic()
    drawn, done = begun, 0
    handle = display.display(display.HTML(_html(0, total, said())), display_id=True)

    def move(number: int) -> None:
        nonlocal drawn, done
        done, now = number, time.monotonic()
        if now - drawn >= EVERY:
            drawn = now
            left = (now - begun) / max(done, 1) * (total - done)
            handle.update(display.HTML(_html(done, total, f"{said()}, {left:.0f} s left")))

    try:
        yield move
    finally:
        # What a notebook keeps is the same each time.
        handle.update(display.HTML(_html(done, total, said())))


def _html(done: int, total: int, said: str) -> str:
    return f'<progress value="{done}" max="{total}"></progress> {escape(said)}'
