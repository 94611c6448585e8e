"""The ids under which Gymnasium knows our scenarios: ``codriving/<scenario>-v1``, and ``-v0`` in the world of 0.1."""

from itertools import product
from pathlib import Path

import gymnasium

from codriving.config import choices
from codriving.gym.joint import JointDriving

SUITES = {0: "paper", 1: "default"}  # The world of each version of an id


def env_id(scenario: str, version: int = 1) -> str:
    """Return the id of a scenario."""
    return f"codriving/{scenario}-v{version}"


def register_scenarios(config_dir: str | Path | None = None) -> None:
    """Register every scenario with Gymnasium; those that it knows already stay as they are."""
    ours, folder = choices("scenario"), None if config_dir is None else Path(config_dir)
    for name, (version, suite) in product(choices("scenario", folder), SUITES.items()):
        if (known := env_id(name, version)) not in gymnasium.registry:
            own = {} if name in ours else {"config_dir": str(folder)}
            # The class itself, since Gymnasium reads the render modes off it.
            gymnasium.register(known, JointDriving, kwargs={"name": name, "suite": suite, **own})  # type: ignore[arg-type]
