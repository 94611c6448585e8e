"""Every method in every scenario at every CDA level: the same seed gives the same episode."""

from typing import Any

import pytest

from codriving.config.choices import choices
from codriving.config.compose import compose
from codriving.environment.environment import Environment
from codriving.experiment.objects import make_objects

DECISIONS = 6
SEED = 11


def episode(config: dict[str, Any]) -> tuple[list[dict[str, Any]], list[tuple[Any, ...]]]:
    """The decisions and the bytes of the trajectories of a short episode, everything built anew."""
    environment, driver, *_ = make_objects(config)
    assert isinstance(environment, Environment)
    world = environment.reset(SEED)
    driver.reset(environment.road_map, environment.driving_model, SEED)
    lines = []
    while environment.outcome is None and len(lines) < DECISIONS:
        deliberation = driver.act(world)
        lines.append(deliberation.as_dict())
        world = environment.step(deliberation.actions)
    tracks = [
        (t.id, t.route, t.action, *(getattr(t, name).tobytes() for name in ("x", "y", "heading", "speed")))
        for t in environment.trajectory().tracks
    ]
    return lines, tracks


@pytest.mark.parametrize("cda", choices("cda"))
@pytest.mark.parametrize("scenario", choices("scenario"))
@pytest.mark.parametrize("method", choices("method"))
def test_same_seed_same_episode(method: str, scenario: str, cda: str) -> None:
    config = compose([f"method={method}", f"scenario={scenario}", f"cda={cda}"])
    first, second = episode(config), episode(config)
    assert first[0], "an episode that is over before the first decision says nothing"
    assert first == second
