"""What is driven in a training, how often and from when on, and the numbers that change on the way."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any

from codriving.config import compose_named
from codriving.errors import ConfigError
from codriving.gym import RewardWeights
from codriving.methods import ACTIONS

if TYPE_CHECKING:
    from codriving.gym import ObserverFactory, ParallelDriving, SingleDriving


def at_least(part: object, **least: int) -> None:
    """Refuse settings, by name, that are smaller than the numbers here."""
    for name, smallest in least.items():
        if getattr(part, name) < smallest:
            raise ConfigError(f"{name} must be {smallest} or more, got {getattr(part, name)}")


def overrides(world: Mapping[str, str]) -> tuple[str, ...]:
    """Return the overrides of a run that say in what world it drives."""
    return tuple(f"{group}={choice}" for group, choice in world.items())


def world_of(chosen: Mapping[str, str]) -> dict[str, str]:
    """Return which limits and drivers a training has, of what its config chooses."""
    _, choices = compose_named(overrides(chosen))
    return {group: choices[group] for group in ("limits", "drivers")}


@dataclass(frozen=True, slots=True)
class Linear:
    """A number that goes from one value to another in a straight line, and then stays."""

    start: float
    end: float
    over: int

    def __post_init__(self) -> None:
        at_least(self, over=1)

    def at(self, decisions: int) -> float:
        """Return the value after some decisions."""
        return self.start + min(max(decisions, 0) / self.over, 1.0) * (self.end - self.start)


@dataclass(frozen=True)
class CooperativeTraffic:
    """One kind of traffic; each number of CAVs is an environment of its own."""

    scenario: str
    cavs: tuple[int, int]
    hdvs: tuple[int, int]
    weight: float
    since: float
    settings: Mapping[str, Any]
    world: Mapping[str, str] = field(default_factory=dict)  # That of the training

    def __post_init__(self) -> None:
        if self.cavs[0] > self.cavs[1]:
            raise ConfigError(f"cavs must be smallest and largest, got {list(self.cavs)}")
        if self.weight < 0:
            raise ConfigError(f"weight must be 0 or more, got {self.weight:g}")
        if not 0 <= self.since <= 1:
            raise ConfigError(f"since must be 0 to 1, got {self.since:g}")

    def environments(self, reward: RewardWeights) -> "tuple[ParallelDriving, ...]":
        """Return an environment for each number of CAVs."""
        from codriving.gym import ParallelDriving

        settings = {"hdvs": list(self.hdvs), **self.settings}
        numbers = range(self.cavs[0], self.cavs[1] + 1)
        make = partial(ParallelDriving, self.scenario, *overrides(self.world), rows=1, reward=reward, **settings)
        return tuple(make(cavs=n) for n in numbers)


def shares(kinds: tuple[CooperativeTraffic, ...], progress: float) -> list[float]:
    """Return how often each kind of traffic is driven at a moment of the training; the sum is 1."""
    weights = [kind.weight if progress >= kind.since else 0.0 for kind in kinds]
    return [weight / sum(weights) for weight in weights]


@dataclass(frozen=True)
class SingleTraffic:
    """One kind of traffic, in which a single CAV is left and all others are human drivers."""

    scenario: str
    cavs: int
    hdvs: tuple[int, int]
    copies: int
    settings: Mapping[str, Any]
    world: Mapping[str, str] = field(default_factory=dict)  # That of the training

    def __post_init__(self) -> None:
        at_least(self, copies=1)

    def environment(self, observer: "ObserverFactory", family: str, reward: RewardWeights) -> "SingleDriving":
        """Return an environment of this kind."""
        from codriving.gym import SingleDriving

        settings = {"hdvs": list(self.hdvs), **self.settings}
        make = partial(SingleDriving, self.scenario, observer, ACTIONS[family], overrides(self.world))
        return make(reward=reward, cavs=self.cavs, **settings)
