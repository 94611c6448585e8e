"""Scenarios with their settings from conf/, and what every scene has to fulfil."""

from functools import cache
from itertools import combinations
from typing import Any

from codriving.config.compose import compose
from codriving.config.target import find_class
from codriving.datatypes.parts import Scenario
from codriving.datatypes.world import Kind, Scene, Start

LENGTH = 5.0


@cache
def _composed(name: str) -> dict[str, Any]:
    return compose([f"scenario={name}"])["scenario"]


def scenario(name: str, **change: Any) -> Scenario:
    """A scenario with the settings of its YAML, and some that are changed."""
    node = {key: tuple(value) if isinstance(value, list) else value for key, value in _composed(name).items()}
    made: Scenario = find_class(node.pop("_target_"), name)(**{**node, **change})
    return made


def can_brake(behind: Start, ahead: Start, distance: float) -> bool:
    """Whether a follower starts with 2 m, 0.8 s and the difference of the stopping distances at 4 m/s2."""
    needed = 2.0 + 0.8 * behind.speed + max(0.0, (behind.speed**2 - ahead.speed**2) / 8.0)
    return distance - LENGTH >= needed - 1e-9


def check_people(scene: Scene, cavs: int, hdvs: tuple[int, int], speeds: dict[Kind, tuple[float, float]]) -> None:
    """Names, numbers and speeds."""
    names = [start.id for start in scene.starts]
    assert names[:cavs] == [f"CAV{k + 1}" for k in range(cavs)]
    assert names[cavs:] == [f"HDV{k + 1}" for k in range(len(names) - cavs)]
    assert hdvs[0] <= len(names) - cavs <= hdvs[1]
    for start in scene.starts:
        assert start.kind is Kind(start.id[:3])
        assert speeds[start.kind][0] <= start.speed <= speeds[start.kind][1]


def check_room(starts: list[Start], spacing: float) -> None:
    """Distances of vehicles on one lane that does not run in a circle."""
    for one, other in combinations(starts, 2):
        behind, ahead = sorted((one, other), key=lambda start: start.position)
        distance = ahead.position - behind.position
        assert distance >= spacing
        assert can_brake(behind, ahead, distance)
