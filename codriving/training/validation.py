"""How well a network drives without exploring, on seeds that it was not trained on."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

from codriving.datatypes import Ending
from codriving.methods import AnyNetwork, Features, greedy
from codriving.training.curriculum import at_least, overrides
from codriving.training.episode import drive

if TYPE_CHECKING:
    from codriving.gym import ParallelDriving


@dataclass(frozen=True)
class Exam:
    """One kind of traffic that is validated."""

    name: str
    scenario: str
    cavs: int
    hdvs: tuple[int, int]
    episodes: int
    settings: Mapping[str, Any] = field(default_factory=dict)
    world: Mapping[str, str] = field(default_factory=dict)  # That of the training

    def __post_init__(self) -> None:
        at_least(self, episodes=1)

    @cached_property
    def environment(self) -> "ParallelDriving":
        """Its environment."""
        from codriving.gym import ParallelDriving

        return ParallelDriving(
            self.scenario, *overrides(self.world), rows=1, cavs=self.cavs, hdvs=list(self.hdvs), **self.settings
        )


@dataclass(frozen=True, slots=True)
class Grade:
    """The result of an exam."""

    success: float
    collision: float
    duration: float | None  # Mean duration of the successful ones [s]; None without any


def examine(exam: Exam, network: AnyNetwork, family: str, shared: bool, first_seed: int, episodes: int) -> Grade:
    """Drive an exam greedily."""
    env = exam.environment
    features = features_of(env, family, shared)
    endings, durations = [], []
    for seed in range(first_seed, first_seed + episodes):
        for _ in drive(env, seed, features, family, lambda seen, masks: greedy(network(seen), masks)):
            pass
        outcome = env.environment.outcome
        assert outcome is not None
        endings.append(outcome.ending)
        if outcome.ending is Ending.SUCCESS:
            durations.append(outcome.time)
    mean = sum(durations) / len(durations) if durations else None
    return Grade(len(durations) / episodes, endings.count(Ending.COLLISION) / episodes, mean)


def features_of(env: "ParallelDriving", family: str, shared: bool) -> Features:
    """Return what agents observe of an environment."""
    return Features(env.environment.road_map, env.environment.driving_model, family, shared)
