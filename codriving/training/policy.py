"""The policy of a single learner: an actor that keeps to what is allowed, a critic, and a pull towards a teacher."""

from collections.abc import Callable
from typing import Any

import torch
from stable_baselines3.common.policies import ActorCriticPolicy
from torch import Tensor, nn

from codriving.methods import AnyNetwork
from codriving.training.attention import AttentionActor
from codriving.training.double_dqn import as_numpy, perceptron

SURE = 0.9  # Probability of the advised action in the distribution of a teacher; the other actions share the rest


class DriverPolicy(ActorCriticPolicy):
    """Actor and critic for observations that are features, mask and advice in one row (see ``AdvisedObserver``).

    Stable-Baselines3 adds to its loss what ``evaluate_actions`` returns as entropy, times a coefficient. The divergence
    from the teacher enters by the same door: entropy - pull KL(teacher || policy), with the pull in units of that
    coefficient. So the loss is that of PPO plus beta KL (TeLL, Xu et al., 2025).
    """

    def __init__(self, *args: Any, features: int, hidden: tuple[int, ...], attends: bool, **kwargs: Any) -> None:  # noqa: ANN401
        self._features, self._hidden, self._attends = features, hidden, attends
        self.pull = 0.0
        super().__init__(*args, **kwargs)

    def _build(self, lr_schedule: Callable[[float], float]) -> None:
        """Make the networks; called by the class above."""
        self._outputs = int(self.action_space.n)
        self.actor: nn.Module = (
            AttentionActor(self._features, self._hidden, self._outputs)
            if self._attends
            else perceptron((self._features, *self._hidden, self._outputs))
        )
        self.critic = perceptron((self._features, *self._hidden, 1))
        for network in (self.actor, self.critic):
            for layer in network.modules():
                if isinstance(layer, nn.Linear):
                    nn.init.orthogonal_(layer.weight, 2**0.5)
                    nn.init.zeros_(layer.bias)
        # A first policy that prefers nothing explores best.
        nn.init.orthogonal_([layer for layer in self.actor.modules() if isinstance(layer, nn.Linear)][-1].weight, 0.01)
        self.optimizer = torch.optim.Adam(self.parameters(), lr=lr_schedule(1), eps=1e-5)

    def forward(self, obs: Tensor, deterministic: bool = False) -> tuple[Tensor, Tensor, Tensor]:
        """Return actions, values and the logarithms of the actions' probabilities."""
        logs = self._logs(obs)
        actions = logs.argmax(1) if deterministic else torch.multinomial(logs.exp(), 1).squeeze(1)
        return actions, self.predict_values(obs), logs.gather(1, actions[:, None]).squeeze(1)

    def evaluate_actions(self, obs: Tensor, actions: Tensor) -> tuple[Tensor, Tensor, Tensor]:
        """Return values, logarithms of the actions' probabilities, and entropy less the pull towards the teacher."""
        logs = self._logs(obs)
        chosen = logs.gather(1, actions.long()[:, None]).squeeze(1)
        entropy = -(logs.exp() * logs).sum(1)
        if self.pull > 0:
            entropy = entropy - self.pull * self.divergence(obs, logs)
        return self.predict_values(obs), chosen, entropy

    def divergence(self, obs: Tensor, logs: Tensor) -> Tensor:
        """Return KL(teacher || policy) of each row; 0 where there is no advice."""
        mask, advice = self._mask(obs), obs[:, self._features + self._outputs :]
        others = mask & (advice < 0.5)
        rest = others.sum(1, keepdim=True)
        teacher = torch.where(advice > 0.5, torch.where(rest > 0, SURE, 1.0), others * (1 - SURE) / rest.clamp(min=1))
        terms = torch.where(teacher > 0, teacher * (teacher.clamp(min=1e-9).log() - logs), 0.0)
        return torch.where(advice.sum(1, keepdim=True) > 0.5, terms, 0.0).sum(1)

    def predict_values(self, obs: Tensor) -> Tensor:
        """Return what the critic expects (n, 1)."""
        values: Tensor = self.critic(obs[:, : self._features])
        return values

    def _mask(self, obs: Tensor) -> Tensor:
        return obs[:, self._features : self._features + self._outputs] > 0.5

    def _logs(self, obs: Tensor) -> Tensor:
        """Logarithms of probabilities; those of forbidden actions are so low that they are never drawn."""
        return torch.log_softmax(self.actor(obs[:, : self._features]).masked_fill(~self._mask(obs), -1e9), 1)


def actor_as_numpy(actor: nn.Module) -> AnyNetwork:
    """Return an actor as numpy computes it."""
    if isinstance(actor, AttentionActor):
        return actor.as_numpy()
    assert isinstance(actor, nn.Sequential)
    return as_numpy(actor, live=False)
