"""One run folder, one writer: a lock that the system itself releases when its owner dies."""

import os
import sys
from pathlib import Path
from typing import Self

from codriving.errors import RunFolderError

if sys.platform == "win32":

    def _lock(descriptor: int) -> None:
        """Nothing: two runs at once in one folder are the user's own care there."""

else:
    import fcntl

    def _lock(descriptor: int) -> None:
        """Lock an open file, or raise BlockingIOError."""
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)


class FolderLock:
    """An advisory lock on a folder, held until closed or until the process ends."""

    def __init__(self, folder: Path) -> None:
        """Take the lock.

        Args:
            folder: Folder to lock; a file ``.lock`` is made in it.

        Raises:
            RunFolderError: If another process holds it.
            OSError: If the folder cannot be written.
        """
        self._descriptor: int | None = os.open(folder / ".lock", os.O_RDWR | os.O_CREAT, 0o666)
        try:
            _lock(self._descriptor)
        except BlockingIOError:
            self.close()
            raise RunFolderError(
                f"{folder} is being written by another run; wait for it or choose another run=<name>"
            ) from None
        except OSError:
            # Some network file systems know no locks; working without one beats not working.
            return

    def close(self) -> None:
        """Give the lock back."""
        if self._descriptor is not None:
            os.close(self._descriptor)
            self._descriptor = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
