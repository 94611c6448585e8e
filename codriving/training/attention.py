"""An actor that attends to others one by one: a token a slot, and the ego vehicle asks (TeLL, Xu et al., 2025)."""

import torch
from torch import Tensor, nn

from codriving.methods import EGO, HEADS, SLOT, SLOTS, WIDTH, Attention, FloatArray
from codriving.training.double_dqn import as_numpy, perceptron


class AttentionActor(nn.Module):
    """One layer of attention over slots, then a perceptron (the same function as ``learning.attention.Attention``)."""

    def __init__(self, features: int, hidden: tuple[int, ...], outputs: int) -> None:
        super().__init__()
        self.ego, self.other = nn.Linear(features - SLOTS * len(SLOT), WIDTH), nn.Linear(len(SLOT), WIDTH)
        self.query, self.key, self.value = (nn.Linear(WIDTH, WIDTH) for _ in range(3))
        self.judge = perceptron((2 * WIDTH, *hidden, outputs))

    def forward(self, observations: Tensor) -> Tensor:
        """Return one number an action (n, actions)."""
        first, last = len(EGO), len(EGO) + SLOTS * len(SLOT)
        slots = observations[:, first:last].reshape(-1, SLOTS, len(SLOT))
        ego = torch.relu(self.ego(torch.cat([observations[:, :first], observations[:, last:]], 1)))
        # The ego vehicle is a token as well, so that there is one to attend to on an empty road.
        tokens = torch.cat([ego[:, None], torch.relu(self.other(slots))], 1)
        there = torch.cat([torch.ones_like(slots[:, :1, 0]), slots[:, :, 0]], 1) > 0.0
        shape = (-1, SLOTS + 1, HEADS, WIDTH // HEADS)
        key, value = self.key(tokens).reshape(shape), self.value(tokens).reshape(shape)
        query = self.query(ego).reshape(-1, 1, HEADS, WIDTH // HEADS)
        scores = (query * key).sum(3) / (WIDTH // HEADS) ** 0.5
        shares = torch.softmax(scores.masked_fill(~there[:, :, None], -1e9), 1)
        seen = (shares[..., None] * value).sum(1).reshape(-1, WIDTH)
        judged: Tensor = self.judge(torch.cat([ego, seen], 1))
        return judged

    def as_numpy(self) -> Attention:
        """Return the actor as numpy computes it."""

        def plain(layer: nn.Linear) -> tuple[FloatArray, FloatArray]:
            return layer.weight.detach().numpy().T.copy(), layer.bias.detach().numpy().copy()

        layers = {name: plain(getattr(self, name)) for name in Attention.LAYERS}
        return Attention(layers, as_numpy(self.judge, live=False))
