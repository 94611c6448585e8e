"""The ids under which Gymnasium knows our scenarios.

``codriving/<scenario>-v1`` decides for all CAVs, ``codriving/<scenario>-ego-v1`` for one; ``-v0`` in the world of
0.1.
"""

from itertools import product
from pathlib import Path

import gymnasium

from codriving.config import choices
from codriving.gym.ego import EgoDriving
from codriving.gym.joint import JointDriving

SUITES = {0: "paper", 1: "default"}  # The world of each version of an id

FACES = {"": JointDriving, "-ego": EgoDriving}


def env_id(scenario: str, version: int = 1, face: str = "") -> str:
    """Return the id of a scenario."""
    return f"codriving/{scenario}{face}-v{version}"


def register_scenarios(config_dir: str | Path | None = None) -> None:
    """Register every scenario with Gymnasium; those that it knows already stay as they are."""
    ours, folder = choices("scenario"), None if config_dir is None else Path(config_dir)
    for name, (version, suite), (face, made) in product(choices("scenario", folder), SUITES.items(), FACES.items()):
        if (known := env_id(name, version, face)) not in gymnasium.registry:
            own = {} if name in ours else {"config_dir": str(folder)}
            # The class itself, since Gymnasium reads the render modes off it.
            gymnasium.register(known, made, kwargs={"name": name, "suite": suite, **own})  # type: ignore[arg-type]
