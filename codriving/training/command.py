"""The face of a training for the command line: from its config to weights, with what the user has to know."""

import importlib.util
import shlex
import sys
from collections.abc import Sequence
from pathlib import Path

from codriving.config import ROOT, build, compose_training, trainings
from codriving.errors import ConfigError, TrainingError
from codriving.methods import FAMILIES
from codriving.training.settings import MadqnSettings, Settings, SingleSettings

INTERRUPTED = 130  # Exit code of a process that the user stopped (128 + SIGINT)

OWN = ("run", "output")  # Settings of the folder, which do not change what is trained


def run_training(
    learner: str, family: str, overrides: Sequence[str], smoke: bool = False, config_dir: Path | None = None
) -> int:
    """Train a learner, or go on with a training that was stopped: ``codriving train``.

    Args:
        overrides: ``key=value`` tokens; ``run`` and ``output`` name the folder.

    Returns:
        Exit code: 0, or 130 if the user stopped it.

    Raises:
        UserError: If PyTorch is missing, or the config or the folder cannot be used.
    """
    name = named(learner, family, config_dir)
    own, others = _split(overrides)
    config = compose_training(name, others, smoke, config_dir)
    settings = build(config, Settings, "train")
    assert isinstance(settings, MadqnSettings | SingleSettings)
    if importlib.util.find_spec("torch") is None:
        raise TrainingError(
            "training needs PyTorch, which is not installed: in a clone of the repository, make torch or pip install "
            "-e '.[train]'; driving with the trained weights that are shipped needs none"
        )
    from codriving.training.display import Display
    from codriving.training.folder import Stop, open_folder
    from codriving.training.run import train

    path = Path(own.get("output", "outputs"), "train", own.get("run", f"{name}_smoke" if smoke else name))
    words = ["codriving", "train", learner, "--family", family, *(["--smoke"] if smoke else []), *others]
    again = shlex.join([*words, *(f"{key}={value}" for key, value in own.items())])
    with open_folder(path, name, shlex.join(words), config) as folder:
        if folder.best.exists():
            print(f"Nothing to do: this training is finished, its weights are {folder.best}")
            return 0
        stop = Stop()
        try:
            with stop.listening(), Display(f"training {name}", settings.decisions) as display:
                best = train(settings, folder, display, stop)
        except KeyboardInterrupt:
            print(f"\nStopped; the training is kept in {path}.\nGo on with: {again}", file=sys.stderr)
            return INTERRUPTED
    print(f"Trained weights: {best}")
    print(f"Drive with them: codriving run method={learner} method.weights={best}")
    return 0


def named(learner: str, family: str, config_dir: Path | None = None) -> str:
    """Return the name of the config of a training."""
    known = trainings(config_dir)
    ends = tuple(f"_{each}" for each in FAMILIES)
    learners = sorted({each.rpartition("_")[0] for each in known if each.endswith(ends)})
    if learner not in learners:
        raise ConfigError(f"unknown learner {learner!r}; learners: {', '.join(learners)}")
    if family not in FAMILIES:
        raise ConfigError(f"unknown family {family!r}; families: {', '.join(FAMILIES)}")
    name = f"{learner}_{family}"
    if name not in known:
        raise ConfigError(f"there is no training {name}; trainings: {', '.join(known)}")
    return name


def _split(overrides: Sequence[str]) -> tuple[dict[str, str], list[str]]:
    """Return what names the folder, and the other overrides."""
    own = {key: value for token in overrides for key, _, value in [token.partition("=")] if key in OWN}
    for key, value in own.items():
        if not value or not ROOT[key].allows(value):
            raise ConfigError(f"{key} must be {ROOT[key].rule}, got {value!r}")
    return own, [token for token in overrides if token.partition("=")[0] not in OWN]
