"""A trained network in numpy that attends to others one by one: a token a slot, and the ego vehicle asks."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from codriving.methods.learned.layout import EGO, SLOT, SLOTS
from codriving.methods.learned.network import FloatArray, Network

WIDTH = 64
"""Numbers in a token."""

HEADS = 4
"""Heads of the attention; each has its share of these numbers."""

OWN = "ego"
"""The layer that takes what is no slot: the ego vehicle, and on lanes what is beside it."""


@dataclass(frozen=True, slots=True)
class Attention:
    """One layer of attention over slots, then a multilayer perceptron (after TeLL, Xu et al., 2025).

    Attributes:
        layers: Weight and bias of each of ``LAYERS``, by name.
    """

    LAYERS: ClassVar[tuple[str, ...]] = (OWN, "other", "query", "key", "value")

    layers: Mapping[str, tuple[FloatArray, FloatArray]]
    judge: Network

    def __call__(self, observations: FloatArray) -> FloatArray:
        """Return what the network makes of some observations.

        Args:
            observations: One a row (n, inputs).

        Returns:
            One row each (n, outputs).
        """
        first, last = len(EGO), len(EGO) + SLOTS * len(SLOT)
        slots = observations[:, first:last].reshape(-1, SLOTS, len(SLOT))
        own = np.concatenate([observations[:, :first], observations[:, last:]], axis=1)
        ego = np.maximum(self._layer(OWN, own), 0.0)
        tokens = np.concatenate([ego[:, None], np.maximum(self._layer("other", slots), 0.0)], axis=1)
        there = np.concatenate([np.ones_like(slots[:, :1, 0]), slots[:, :, 0]], axis=1) > 0.0
        shape = (-1, SLOTS + 1, HEADS, WIDTH // HEADS)
        key, value = (self._layer(name, tokens).reshape(shape) for name in ("key", "value"))
        query = self._layer("query", ego).reshape(-1, 1, HEADS, WIDTH // HEADS)
        scores = (query * key).sum(axis=3) / np.float32((WIDTH // HEADS) ** 0.5)
        scores = np.where(there[:, :, None], scores, -np.inf)
        shares = np.exp(scores - scores.max(axis=1, keepdims=True))
        shares /= shares.sum(axis=1, keepdims=True)
        seen = (shares[..., None] * value).sum(axis=1).reshape(-1, WIDTH)
        return self.judge(np.concatenate([ego, seen], axis=1))

    def _layer(self, name: str, inputs: FloatArray) -> FloatArray:
        weight, bias = self.layers[name]
        return np.asarray(inputs @ weight + bias)
