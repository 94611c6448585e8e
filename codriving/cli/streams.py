"""Standard streams that are closed, full or of a narrow encoding: what cannot be said is lost, and nothing else."""

import errno
import io
import os
import sys
from contextlib import suppress
from typing import TYPE_CHECKING, TextIO

from codriving.errors import UserError

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer


class OutputError(UserError):
    """Raised when standard output takes no more."""

    def __init__(self, cause: OSError) -> None:
        super().__init__(
            f"cannot write to standard output ({cause.strerror}); send it to another place: what was driven is kept, "
            "and the same command with the same run=<name> prints its table again"
        )
        self.reader_is_gone = cause.errno == errno.EPIPE  # As in ``codriving list | head -1``


class _Said(io.FileIO):
    """Standard error: a line that cannot be written stops no batch."""

    def write(self, data: "ReadableBuffer", /) -> int:
        try:
            return super().write(data)
        except OSError:
            return memoryview(data).nbytes


class _Output(io.FileIO):
    """Standard output: told from all other files by its error."""

    def write(self, data: "ReadableBuffer", /) -> int:
        try:
            return super().write(data)
        except OSError as error:
            raise OutputError(error) from error


def mend_streams() -> None:
    """Open what is closed, and put up with what is full or cannot show a character; only for streams of the process."""
    for descriptor in range(3):
        try:
            os.fstat(descriptor)
        except OSError:
            # The lowest number that is free: no file of ours may take it, for libraries write to 1 and 2 unasked.
            os.open(os.devnull, os.O_RDWR)
    if sys.stdin is None:
        sys.stdin = open(0, closefd=False)  # noqa: SIM115 - it is open as long as the process
    if sys.stdout is sys.__stdout__:
        sys.stdout = _text(_Output(1, "w", closefd=False), sys.__stdout__)
    if sys.stderr is sys.__stderr__:
        sys.stderr = _text(_Said(2, "w", closefd=False), sys.__stderr__)


def _text(raw: io.FileIO, former: TextIO | None) -> io.TextIOWrapper:
    return io.TextIOWrapper(
        io.BufferedWriter(raw),
        encoding=getattr(former, "encoding", None) or "utf-8",
        errors="backslashreplace",
        line_buffering=raw.fileno() == 2 or raw.isatty(),
        write_through=getattr(former, "write_through", False),
    )


def give_up_output() -> None:
    """Send the rest of standard output nowhere, so that it is not tried again when the process ends."""
    with suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)
