"""Every number of a training; the YAMLs in conf/train are calls of these classes."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from codriving.errors import ConfigError
from codriving.gym import RewardWeights, reward_weights
from codriving.methods import FAMILIES, FORMS, PERCEPTRON, Madqn, Ppo, Tell
from codriving.training.curriculum import CooperativeTraffic, Linear, SingleTraffic, at_least
from codriving.training.teacher import Guidance
from codriving.training.validation import Exam

LEAST_SEED = 10_000  # Seeds below this are for tables alone


@dataclass(frozen=True)
class Settings:
    """What every training has to know: what is learned, how it is validated and which states are kept."""

    family: str  # ``junction`` or ``lanes``
    seed: int
    decisions: int
    hidden: tuple[int, ...]
    batch: int
    discount: float
    clip: float
    rate: Linear
    reward: Mapping[str, float]
    # Choices of ``suite``, ``limits`` and ``drivers`` in which it trains and is validated; release 0.1 knew one world.
    world: Mapping[str, str] = field(default_factory=lambda: {"suite": "paper"}, kw_only=True)
    exams: tuple[Exam, ...]
    exam_every: int
    exam_seed: int  # First seed of the validations; ``LEAST_SEED`` or more
    finalists: int
    final_episodes: int

    def __post_init__(self) -> None:
        self._one_of("family", FAMILIES)
        at_least(self, seed=0, decisions=1, exam_every=1, exam_seed=LEAST_SEED, finalists=1, final_episodes=1)
        if not self.hidden or min(self.hidden) < 1:
            raise ConfigError(f"hidden must name the units of at least one layer, got {list(self.hidden)}")
        self._below_one("discount")
        reward_weights(self.reward)
        for name in ("exams", "traffic"):
            parts = tuple(replace(part, world=self.world) for part in getattr(self, name))
            object.__setattr__(self, name, parts)

    def _one_of(self, name: str, choices: tuple[str, ...]) -> None:
        if getattr(self, name) not in choices:
            raise ConfigError(f"{name} must be one of {', '.join(choices)}, got {getattr(self, name)!r}")

    def _below_one(self, name: str) -> None:
        if not 0 <= getattr(self, name) < 1:
            raise ConfigError(f"{name} must be at least 0 and below 1, got {getattr(self, name):g}")

    @property
    def weights(self) -> RewardWeights:
        """The weights of the reward."""
        return reward_weights(self.reward)


@dataclass(frozen=True)
class SingleSettings(Settings):
    """How a network is trained by PPO (Schulman et al., 2017), with one CAV that learns."""

    learner: str  # ``ppo`` or ``tell``
    form: str  # Kind of the actor, ``perceptron`` or ``attention``
    rollout: int
    epochs: int
    trace: float
    entropy: float
    guidance: Guidance | None  # The teacher; None for none
    traffic: tuple[SingleTraffic, ...]

    shared = False  # A vehicle on its own is told nothing by others

    def __post_init__(self) -> None:
        self._one_of("learner", (Ppo.name, Tell.name))
        self._one_of("form", FORMS)
        super().__post_init__()
        at_least(self, rollout=2, batch=2, epochs=1)
        self._below_one("trace")
        self._below_one("clip")
        if self.entropy <= 0:
            raise ConfigError(f"entropy must be positive, got {self.entropy:g}")
        if not self.exams or not self.traffic:
            raise ConfigError("traffic and exams must hold at least one kind each")

    @property
    def teacher(self) -> str:
        """Name of the teacher; empty for none."""
        return "" if self.guidance is None else self.guidance.llm.name


@dataclass(frozen=True)
class MadqnSettings(Settings):
    """How a network is trained by Double DQN, with all CAVs learning together."""

    steps: int
    capacity: int
    warm_up: int
    every: int
    average: float
    exploration: Linear
    faster: float
    traffic: tuple[CooperativeTraffic, ...]

    learner, form, teacher = Madqn.name, PERCEPTRON, ""
    shared = True  # CAVs share states and intents

    def __post_init__(self) -> None:
        super().__post_init__()
        at_least(self, steps=1, capacity=1, warm_up=1, batch=1, every=1)
        if not 0 < self.average <= 1:
            raise ConfigError(f"average must be above 0 and at most 1, got {self.average:g}")
        if self.clip <= 0 or self.faster <= 0:
            raise ConfigError(f"clip and faster must be positive, got {self.clip:g} and {self.faster:g}")
        for name in ("start", "end"):
            if not 0 <= getattr(self.exploration, name) <= 1:
                raise ConfigError(f"exploration.{name} must be 0 to 1, got {getattr(self.exploration, name):g}")
        if not self.exams or not any(kind.weight > 0 and kind.since == 0 for kind in self.traffic):
            raise ConfigError("traffic must hold a kind that is driven from the beginning, and exams at least one")
