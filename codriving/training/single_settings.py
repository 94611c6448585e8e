"""Every number of a training of a vehicle on its own; the configs of PPO and TeLL are calls of this."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from codriving.errors import ConfigError
from codriving.gym.reward import RewardWeights, reward_weights
from codriving.methods.learned.actions import ACTIONS
from codriving.methods.learned.forms import FORMS
from codriving.methods.learned.layout import FAMILIES
from codriving.training.schedule import Linear
from codriving.training.settings import LEAST_SEED
from codriving.training.teacher import Guidance
from codriving.training.validation import Exam

if TYPE_CHECKING:
    from codriving.gym.single import ObserverFactory, SingleDriving
    from codriving.training.single_trainer import SingleTrainer

LEARNERS = ("ppo", "tell")


@dataclass(frozen=True)
class SingleTraffic:
    """One kind of traffic, in which a single CAV is left and all others are human drivers.

    Raises:
        ConfigError: If there are no copies.
    """

    scenario: str
    cavs: int
    hdvs: tuple[int, int]
    copies: int
    settings: Mapping[str, Any]

    def __post_init__(self) -> None:
        if self.copies < 1:
            raise ConfigError(f"copies must be 1 or more, got {self.copies}")

    def environment(self, observer: "ObserverFactory", family: str, reward: RewardWeights) -> "SingleDriving":
        """Return an environment of this kind.

        Raises:
            ConfigError: If the scenario refuses a setting.
        """
        from codriving.gym.single import SingleDriving

        settings = {"hdvs": list(self.hdvs), **self.settings}
        return SingleDriving(self.scenario, observer, ACTIONS[family], reward=reward, cavs=self.cavs, **settings)


@dataclass(frozen=True)
class SingleSettings:
    """How a network is trained by PPO (Schulman et al., 2017), with one CAV that learns.

    Attributes:
        learner: ``ppo`` or ``tell``.
        family: ``junction`` or ``lanes``.
        form: Kind of the actor, ``perceptron`` or ``attention``.
        guidance: The teacher; None for none.

    Raises:
        ConfigError: If a value is out of range.
    """

    learner: str
    family: str
    seed: int
    decisions: int
    form: str
    hidden: tuple[int, ...]
    rollout: int
    batch: int
    epochs: int
    discount: float
    trace: float
    clip: float
    entropy: float
    rate: Linear
    guidance: Guidance | None
    reward: Mapping[str, float]
    traffic: tuple[SingleTraffic, ...]
    exams: tuple[Exam, ...]
    exam_every: int
    exam_seed: int
    finalists: int
    final_episodes: int

    shared = False
    """A vehicle on its own is told nothing by others."""

    def __post_init__(self) -> None:
        for name, choices in (("learner", LEARNERS), ("family", FAMILIES), ("form", FORMS)):
            if getattr(self, name) not in choices:
                raise ConfigError(f"{name} must be one of {', '.join(choices)}, got {getattr(self, name)!r}")
        for name, low in (
            ("seed", 0),
            ("decisions", 1),
            ("rollout", 2),
            ("batch", 2),
            ("epochs", 1),
            ("exam_every", 1),
            ("exam_seed", LEAST_SEED),
            ("finalists", 1),
            ("final_episodes", 1),
        ):
            if getattr(self, name) < low:
                raise ConfigError(f"{name} must be {low} or more, got {getattr(self, name)}")
        if not self.hidden or min(self.hidden) < 1:
            raise ConfigError(f"hidden must name the units of at least one layer, got {list(self.hidden)}")
        for name, value in (("discount", self.discount), ("trace", self.trace), ("clip", self.clip)):
            if not 0 <= value < 1:
                raise ConfigError(f"{name} must be at least 0 and below 1, got {value:g}")
        if self.entropy <= 0:
            raise ConfigError(f"entropy must be positive, got {self.entropy:g}")
        if not self.exams or not self.traffic:
            raise ConfigError("traffic and exams must hold at least one kind each")
        reward_weights(self.reward)

    @property
    def weights(self) -> RewardWeights:
        """What is rewarded."""
        return reward_weights(self.reward)

    def trainer(self) -> "SingleTrainer":
        """Return a training that has not begun."""
        from codriving.training.single_trainer import SingleTrainer

        return SingleTrainer(self)

    @property
    def teacher(self) -> str:
        """Name of the teacher; empty for none."""
        return "" if self.guidance is None else self.guidance.llm.name
