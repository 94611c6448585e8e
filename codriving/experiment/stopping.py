"""SIGTERM and SIGHUP stop a batch as Ctrl-C does: what is finished is kept, and a line says how to go on."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

# What a scheduler, a service manager or ``kill`` sends, and a terminal that is closed; Windows has no SIGHUP.
NAMES = ("SIGTERM", "SIGHUP")


class StopSignal(KeyboardInterrupt):
    """Raised where a signal arrives that asks the process to stop."""

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.number = number


@contextmanager
def stopped_by_signals() -> Iterator[None]:
    """Raise where a signal arrives, once; a signal that is ignored (``nohup``) or handled by others stays so."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    numbers = [getattr(signal, name) for name in NAMES if hasattr(signal, name)]
    ours = [number for number in numbers if signal.getsignal(number) is signal.SIG_DFL]

    def stop(number: int, frame: FrameType | None) -> None:
        # What follows puts everything in order, which takes a moment and must not be broken off.
        for one in ours:
            signal.signal(one, signal.SIG_IGN)
        raise StopSignal(number)

    for number in ours:
        signal.signal(number, stop)
    try:
        yield
    finally:
        for number in ours:
            signal.signal(number, signal.SIG_DFL)
