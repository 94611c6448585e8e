"""The ids under which Gymnasium knows our scenarios: ``codriving/<scenario>-v0``."""

from pathlib import Path

import gymnasium

from codriving.config import choices
from codriving.gym.joint import JointDriving


def env_id(scenario: str) -> str:
    """Return the id of a scenario."""
    return f"codriving/{scenario}-v0"


def register_scenarios(config_dir: str | Path | None = None) -> None:
    """Register every scenario with Gymnasium; those that it knows already stay as they are."""
    ours, folder = choices("scenario"), None if config_dir is None else Path(config_dir)
    for name in choices("scenario", folder):
        if env_id(name) not in gymnasium.registry:
            own = {} if name in ours else {"config_dir": str(folder)}
            # The class itself, since Gymnasium reads the render modes off it.
            gymnasium.register(env_id(name), JointDriving, kwargs={"name": name, **own})  # type: ignore[arg-type]
