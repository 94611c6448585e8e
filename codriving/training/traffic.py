"""What is driven in a training: scenarios, how many CAVs and human drivers, and from when on."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from codriving.errors import ConfigError
from codriving.gym.reward import RewardWeights

if TYPE_CHECKING:
    from codriving.gym.parallel import ParallelDriving


@dataclass(frozen=True)
class Traffic:
    """One kind of traffic; each number of CAVs is an environment of its own.

    Raises:
        ConfigError: If a value is out of range.
    """

    scenario: str
    cavs: tuple[int, int]
    hdvs: tuple[int, int]
    weight: float
    since: float
    settings: Mapping[str, Any]

    def __post_init__(self) -> None:
        if self.cavs[0] > self.cavs[1]:
            raise ConfigError(f"cavs must be smallest and largest, got {list(self.cavs)}")
        if self.weight < 0:
            raise ConfigError(f"weight must be 0 or more, got {self.weight:g}")
        if not 0 <= self.since <= 1:
            raise ConfigError(f"since must be 0 to 1, got {self.since:g}")

    def environments(self, reward: RewardWeights) -> "tuple[ParallelDriving, ...]":
        """Return an environment for each number of CAVs.

        Raises:
            ConfigError: If the scenario refuses a setting.
        """
        from codriving.gym.parallel import ParallelDriving

        settings = {"hdvs": list(self.hdvs), **self.settings}
        numbers = range(self.cavs[0], self.cavs[1] + 1)
        return tuple(ParallelDriving(self.scenario, rows=1, reward=reward, cavs=n, **settings) for n in numbers)


def shares(kinds: tuple[Traffic, ...], progress: float) -> list[float]:
    """Return how often each kind of traffic is driven at a moment of the training; the sum is 1."""
    weights = [kind.weight if progress >= kind.since else 0.0 for kind in kinds]
    return [weight / sum(weights) for weight in weights]
