"""Every number of a training of MADQN; the configs in conf/train are calls of this."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from codriving.errors import ConfigError
from codriving.gym.reward import RewardWeights, reward_weights
from codriving.methods.learned.forms import PERCEPTRON
from codriving.methods.learned.layout import FAMILIES
from codriving.training.schedule import Linear
from codriving.training.traffic import Traffic
from codriving.training.validation import Exam

if TYPE_CHECKING:
    from codriving.training.trainer import Trainer

LEAST_SEED = 10_000
"""Seeds below this are for tables alone."""


@dataclass(frozen=True)
class MadqnSettings:
    """How a network is trained.

    Attributes:
        family: ``junction`` or ``lanes``.

    Raises:
        ConfigError: If a value is out of range.
    """

    family: str
    seed: int
    decisions: int
    hidden: tuple[int, ...]
    steps: int
    discount: float
    capacity: int
    warm_up: int
    batch: int
    every: int
    average: float
    clip: float
    rate: Linear
    exploration: Linear
    faster: float
    reward: Mapping[str, float]
    traffic: tuple[Traffic, ...]
    exams: tuple[Exam, ...]
    exam_every: int
    exam_seed: int
    finalists: int
    final_episodes: int

    learner, form, teacher = "madqn", PERCEPTRON, ""
    shared = True
    """CAVs tell one another states and intents."""

    def __post_init__(self) -> None:
        if self.family not in FAMILIES:
            raise ConfigError(f"family must be one of {', '.join(FAMILIES)}, got {self.family!r}")
        for name, low in (
            ("seed", 0),
            ("decisions", 1),
            ("steps", 1),
            ("capacity", 1),
            ("warm_up", 1),
            ("batch", 1),
            ("every", 1),
            ("exam_every", 1),
            ("exam_seed", LEAST_SEED),
            ("finalists", 1),
            ("final_episodes", 1),
        ):
            if getattr(self, name) < low:
                raise ConfigError(f"{name} must be {low} or more, got {getattr(self, name)}")
        if not self.hidden or min(self.hidden) < 1:
            raise ConfigError(f"hidden must name the units of at least one layer, got {list(self.hidden)}")
        if not 0 <= self.discount < 1:
            raise ConfigError(f"discount must be at least 0 and below 1, got {self.discount:g}")
        if not 0 < self.average <= 1:
            raise ConfigError(f"average must be above 0 and at most 1, got {self.average:g}")
        if self.clip <= 0 or self.faster <= 0:
            raise ConfigError(f"clip and faster must be positive, got {self.clip:g} and {self.faster:g}")
        for name in ("start", "end"):
            if not 0 <= getattr(self.exploration, name) <= 1:
                raise ConfigError(f"exploration.{name} must be 0 to 1, got {getattr(self.exploration, name):g}")
        if not self.exams or not any(kind.weight > 0 and kind.since == 0 for kind in self.traffic):
            raise ConfigError("traffic must hold a kind that is driven from the beginning, and exams at least one")
        reward_weights(self.reward)

    def trainer(self) -> "Trainer":
        """Return a training that has not begun."""
        from codriving.training.trainer import Trainer

        return Trainer(self)

    @property
    def weights(self) -> RewardWeights:
        """What is rewarded."""
        return reward_weights(self.reward)
