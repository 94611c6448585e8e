"""What is left when a batch does not come to its end: finished episodes are kept, and the run can go on."""

from pathlib import Path

from codriving.errors import ModelError


class Interrupted(KeyboardInterrupt):
    """Raised when the user stops a batch, after everything has been put in order."""

    def __init__(self, folder: Path, finished: int, planned: int) -> None:
        """Say what there is."""
        super().__init__(f"stopped with {finished} of {planned} episodes finished")
        self.folder = folder
        self.finished = finished
        self.planned = planned


class HaltedError(ModelError):
    """Raised when a batch stops since its language model must not be used any more; everything is in order."""

    def __init__(self, reason: ModelError, folder: Path, finished: int, planned: int) -> None:
        """Say why, and what there is."""
        self.text = f"{str(reason).rstrip('.;')}; {finished} of {planned} episodes are finished and kept"
        super().__init__(f"{self.text} in {folder}")
        self.folder = folder
