"""The training of a vehicle on its own: PPO of Stable-Baselines3, one rollout after another."""

from pathlib import Path
from typing import Any

import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.utils import set_random_seed
from stable_baselines3.common.vec_env import DummyVecEnv

from codriving.datatypes import Ending
from codriving.gym import draw_seed
from codriving.methods import ATTENTION, AnyNetwork, feature_count
from codriving.training.advised_observer import AdvisedObserver
from codriving.training.policy import DriverPolicy, actor_as_numpy
from codriving.training.settings import SingleSettings
from codriving.training.teacher import Advisor

NETWORK = "network.pt"

TRIES = 100  # Environments are seeded one by one; so many seeds are left to each rollout of them


class SingleTrainer:
    """Trains a policy; every rollout begins with new episodes and its own seed, so training resumes at any rollout."""

    def __init__(self, settings: SingleSettings) -> None:
        torch.set_num_threads(1)
        torch.use_deterministic_algorithms(True)
        self.settings, self.decisions, self.rollouts = settings, 0, 0
        self._advisors: list[Advisor] = []
        kinds = [kind for kind in settings.traffic for _ in range(kind.copies)]
        environments = [kind.environment(self._observer, settings.family, settings.weights) for kind in kinds]
        self._count = len(environments)
        # A default is bound at once; the variable of the loop would be the last environment for all.
        self._roads = DummyVecEnv([lambda made=environment: made for environment in environments])
        self._endings = _Endings()
        set_random_seed(settings.seed)
        attends = settings.form == ATTENTION
        self._ppo = PPO(
            DriverPolicy,
            self._roads,
            n_steps=settings.rollout,
            batch_size=settings.batch,
            n_epochs=settings.epochs,
            gamma=settings.discount,
            gae_lambda=settings.trace,
            clip_range=settings.clip,
            ent_coef=settings.entropy,
            learning_rate=settings.rate.start,
            policy_kwargs={"features": feature_count(settings.family), "hidden": settings.hidden, "attends": attends},
            device="cpu",
        )
        self._policy: DriverPolicy = self._ppo.policy

    def _observer(self, environment: Any) -> AdvisedObserver:  # noqa: ANN401 - the environment's room is not for this one
        road, guidance = (environment.road_map, environment.driving_model), self.settings.guidance
        if guidance is None:
            return AdvisedObserver(*road, self.settings.family, None)
        self._advisors.append(Advisor(guidance, *road))
        return AdvisedObserver(*road, self.settings.family, self._advisors[-1])

    @property
    def network(self) -> AnyNetwork:
        """The actor as it is now."""
        return actor_as_numpy(self._policy.actor)

    def advance(self) -> None:
        """Drive one rollout and learn from it."""
        settings = self.settings
        rng = np.random.default_rng(np.random.SeedSequence(entropy=settings.seed, spawn_key=(self.rollouts,)))
        # The first episodes take seeds one by one, later ones are drawn by each environment.
        self._roads.seed(draw_seed(rng) // TRIES * TRIES)
        set_random_seed(int(rng.integers(2**31)))
        rate = settings.rate.at(self.decisions)
        self._ppo.lr_schedule = lambda _: rate
        pull = 0.0 if settings.guidance is None else settings.guidance.pull.at(self.decisions)
        self._policy.pull = pull / settings.entropy
        for advisor in self._advisors:
            advisor.asks = pull > 0
        # Which is how Stable-Baselines3 is told to begin new episodes.
        self._ppo._last_obs = None
        self._ppo.learn(settings.rollout * self._count, callback=self._endings, reset_num_timesteps=False)
        self.decisions += settings.rollout * self._count
        self.rollouts += 1

    def section(self) -> dict[str, float | int | None]:
        """Return what a row of the curve says besides the exams, and begin the next section."""
        endings, self._endings.found = self._endings.found, []
        guidance = self.settings.guidance
        return {
            "decisions": self.decisions,
            "updates": self.rollouts,
            "rate": round(self.settings.rate.at(self.decisions), 6),
            "train_success": round(endings.count(Ending.SUCCESS) / len(endings), 4) if endings else None,
            **({} if guidance is None else {"pull": round(guidance.pull.at(self.decisions), 4)}),
        }

    def write(self, folder: Path) -> dict[str, Any]:
        """Write the networks, and return what else the training goes on from."""
        parts = {"policy": self._policy.state_dict(), "optimizer": self._policy.optimizer.state_dict()}
        torch.save(parts, folder / NETWORK)
        return {"decisions": self.decisions, "rollouts": self.rollouts, "endings": list(map(str, self._endings.found))}

    def read(self, folder: Path, state: dict[str, Any]) -> None:
        """Go on from what another one has written."""
        held = torch.load(folder / NETWORK, weights_only=True)
        self.decisions, self.rollouts = int(state["decisions"]), int(state["rollouts"])
        self._endings.found = [Ending(ending) for ending in state["endings"]]
        self._policy.load_state_dict(held["policy"])
        self._policy.optimizer.load_state_dict(held["optimizer"])


class _Endings(BaseCallback):
    """Notes how episodes end."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[Ending] = []

    def _on_step(self) -> bool:
        for done, info in zip(self.locals["dones"], self.locals["infos"], strict=True):
            if done:
                # A CAV that arrives ends its episode, whether the others go on or not.
                self.found.append(Ending.SUCCESS if info["arrived"] else Ending(info["outcome"]))
        return True
