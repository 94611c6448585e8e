"""Everything that a training goes on from, in one folder that is there whole or not at all."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import torch

from codriving.errors import TrainingError
from codriving.storage.atomic import whole_folder, write_text
from codriving.training.trainer import Trainer

NETWORK, REPLAY, STATE = "network.pt", "replay.npz", "state.json"


def store(folder: Path, trainer: Trainer, more: dict[str, Any]) -> None:
    """Write a checkpoint.

    Args:
        folder: Its folder; the one before is replaced.
        trainer: The training, between two episodes.
        more: What else is to be remembered, JSON-ready.
    """
    with whole_folder(folder) as partial:
        torch.save(trainer.learner.state(), partial / NETWORK)
        np.savez(partial / REPLAY, **trainer.replay.state())  # type: ignore[arg-type]
        write_text(partial / STATE, json.dumps({"trainer": trainer.state(), "more": more}))


def recall(folder: Path, trainer: Trainer) -> dict[str, Any]:
    """Go on from a checkpoint.

    Args:
        folder: Its folder.
        trainer: A training with the same settings, which takes its state.

    Returns:
        What else was remembered.

    Raises:
        TrainingError: If the checkpoint is damaged.
    """
    try:
        trainer.learner.restore(torch.load(folder / NETWORK, weights_only=True))
        with np.load(folder / REPLAY, allow_pickle=False) as replay:
            trainer.replay.restore(dict(replay))
        state = json.loads((folder / STATE).read_text(encoding="utf-8"))
        trainer.restore(state["trainer"])
        more: dict[str, Any] = state["more"]
    except (OSError, ValueError, KeyError, TypeError, RuntimeError) as err:
        raise TrainingError(
            f"the checkpoint in {folder} cannot be used ({type(err).__name__}: {err}); delete the run folder to begin anew"
        ) from err
    return more
