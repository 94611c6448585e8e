"""Double DQN (van Hasselt, Guez and Silver, 2016) with one network for all agents (Egorov, 2016)."""

import copy
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import torch
from torch import nn

from codriving.methods import Network
from codriving.training.replay import Batch


def perceptron(sizes: Sequence[int]) -> nn.Sequential:
    """Return a multilayer perceptron."""
    layers: list[nn.Module] = []
    for inputs, outputs in pairwise(sizes):
        layers += [nn.Linear(inputs, outputs), nn.ReLU()]
    return nn.Sequential(*layers[:-1])


class DoubleDqn:
    """A network that judges actions, and its slow average, which judges what comes later and is what is kept."""

    def __init__(self, sizes: Sequence[int], average: float, clip: float, seed: int) -> None:
        torch.set_num_threads(1)
        torch.use_deterministic_algorithms(True)
        torch.manual_seed(seed)
        self.online = perceptron(sizes)
        self.target = copy.deepcopy(self.online)
        self._average, self._clip = average, clip
        self._optimizer = torch.optim.Adam(self.online.parameters(), lr=1e-3)
        self._parts: dict[str, Any] = {"online": self.online, "target": self.target, "optimizer": self._optimizer}

    def update(self, batch: Batch, rate: float) -> float:
        """Learn from a batch.

        The network chooses the later action, its average judges it; Huber loss; the norm of the gradient is clipped.
        """
        observations, later = torch.from_numpy(batch.observations), torch.from_numpy(batch.later)
        with torch.no_grad():
            chosen = self.online(later).masked_fill(~torch.from_numpy(batch.masks), -torch.inf).argmax(1, keepdim=True)
            value = self.target(later).gather(1, chosen).squeeze(1)
            goal = torch.from_numpy(batch.gains) + torch.from_numpy(batch.discounts) * value
        judged = self.online(observations).gather(1, torch.from_numpy(batch.actions)[:, None]).squeeze(1)
        loss = nn.functional.smooth_l1_loss(judged, goal)
        for group in self._optimizer.param_groups:
            group["lr"] = rate
        self._optimizer.zero_grad()
        loss.backward()
        nn.utils.clip_grad_norm_(self.online.parameters(), self._clip)
        self._optimizer.step()
        with torch.no_grad():
            for slow, fast in zip(self.target.parameters(), self.online.parameters(), strict=True):
                slow.lerp_(fast, self._average)
        return float(loss.detach())

    def state(self) -> dict[str, Any]:
        """Return everything that learning goes on from."""
        return {name: part.state_dict() for name, part in self._parts.items()}

    def restore(self, state: dict[str, Any]) -> None:
        """Go on with the state of another one."""
        for name, part in self._parts.items():
            part.load_state_dict(state[name])


def as_numpy(module: nn.Sequential, live: bool) -> Network:
    """Return a network as numpy computes it."""
    layers = [layer for layer in module if isinstance(layer, nn.Linear)]
    weights = [layer.weight.detach().numpy().T for layer in layers]
    biases = [layer.bias.detach().numpy() for layer in layers]
    if not live:
        weights, biases = [w.copy() for w in weights], [b.copy() for b in biases]
    return Network(weights, biases)
