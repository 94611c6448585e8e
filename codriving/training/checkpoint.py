"""Everything that a training goes on from, in one folder that is there whole or not at all."""

import json
from pathlib import Path
from typing import Any, Protocol

from codriving.errors import TrainingError
from codriving.runs.atomic import whole_folder, write_text

STATE = "state.json"


class Resumable(Protocol):
    """A training that can go on from what it has written."""

    def write(self, folder: Path) -> dict[str, Any]:
        """Write what is large into a folder, and return the rest, JSON-ready."""
        ...

    def read(self, folder: Path, state: dict[str, Any]) -> None:
        """Go on from the folder, and from what was returned."""
        ...


def store(folder: Path, trainer: Resumable, more: dict[str, Any]) -> None:
    """Write a checkpoint."""
    with whole_folder(folder) as partial:
        state = trainer.write(partial)
        write_text(partial / STATE, json.dumps({"trainer": state, "more": more}))


def recall(folder: Path, trainer: Resumable) -> dict[str, Any]:
    """Go on from a checkpoint.

    Raises:
        TrainingError: If the checkpoint is damaged.
    """
    try:
        state = json.loads((folder / STATE).read_text(encoding="utf-8"))
        trainer.read(folder, state["trainer"])
        more: dict[str, Any] = state["more"]
    except (OSError, ValueError, KeyError, TypeError, RuntimeError) as err:
        raise TrainingError(
            f"the checkpoint in {folder} cannot be used ({type(err).__name__}: {err}); "
            "delete the run folder to begin anew"
        ) from err
    return more
