"""Trained networks in numpy: a perceptron, attention over slots, and what their outputs mean."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, TypeAlias

import numpy as np
from numpy.typing import NDArray

from codriving.methods.learned.layout import EGO, SLOT, SLOTS

FloatArray = NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class Network:
    """A multilayer perceptron."""

    weights: Sequence[FloatArray]
    biases: Sequence[FloatArray]

    def __call__(self, observations: FloatArray) -> FloatArray:
        """Return what the network makes of some observations."""
        hidden, last = observations, len(self.weights) - 1
        for layer, (weight, bias) in enumerate(zip(self.weights, self.biases, strict=True)):
            hidden = hidden @ weight + bias
            if layer != last:
                hidden = np.maximum(hidden, 0.0)
        return hidden


WIDTH = 64  # Numbers in a token

HEADS = 4  # Heads of the attention; each has its share of these numbers

OWN = "ego"  # The layer that takes what is no slot: the ego vehicle, and on lanes what is beside it


@dataclass(frozen=True, slots=True)
class Attention:
    """One layer of attention over slots, then a multilayer perceptron (after TeLL, Xu et al., 2025)."""

    LAYERS: ClassVar[tuple[str, ...]] = (OWN, "other", "query", "key", "value")

    layers: Mapping[str, tuple[FloatArray, FloatArray]]  # Weight and bias of each of ``LAYERS``, by name
    judge: Network

    def __call__(self, observations: FloatArray) -> FloatArray:
        """Return what the network makes of some observations."""
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


PERCEPTRON, ATTENTION = "perceptron", "attention"
FORMS = (PERCEPTRON, ATTENTION)

AnyNetwork: TypeAlias = Network | Attention


def shapes(form: str, inputs: int, hidden: Sequence[int], outputs: int) -> dict[str, tuple[int, ...]]:
    """Return the shape of every tensor of a network, by name."""
    found: dict[str, tuple[int, ...]] = {}
    if form == ATTENTION:
        taken = {OWN: inputs - SLOTS * len(SLOT), "other": len(SLOT)}
        for name in Attention.LAYERS:
            found[f"{name}.W"], found[f"{name}.b"] = (taken.get(name, WIDTH), WIDTH), (WIDTH,)
        inputs = 2 * WIDTH
    sizes = (inputs, *hidden, outputs)
    for k in range(len(sizes) - 1):
        found[f"W{k}"], found[f"b{k}"] = (sizes[k], sizes[k + 1]), (sizes[k + 1],)
    return found


def tensors(network: AnyNetwork) -> dict[str, FloatArray]:
    """Return every tensor of a network, by name."""
    found: dict[str, FloatArray] = {}
    judge = network
    if isinstance(network, Attention):
        for name, (weight, bias) in network.layers.items():
            found[f"{name}.W"], found[f"{name}.b"] = weight, bias
        judge = network.judge
    assert isinstance(judge, Network)
    for k, (weight, bias) in enumerate(zip(judge.weights, judge.biases, strict=True)):
        found[f"W{k}"], found[f"b{k}"] = weight, bias
    return found


def network_of(form: str, found: Mapping[str, FloatArray]) -> AnyNetwork:
    """Put a network together."""
    layers = range(sum(1 for name in found if name[0] == "W"))
    judge = Network([found[f"W{k}"] for k in layers], [found[f"b{k}"] for k in layers])
    if form == PERCEPTRON:
        return judge
    return Attention({name: (found[f"{name}.W"], found[f"{name}.b"]) for name in Attention.LAYERS}, judge)


def greedy(values: FloatArray, masks: NDArray[np.bool_]) -> list[int]:
    """Return the best allowed action of each row; of several alike the first.

    Args:
        values: Value of each action (n, actions).
        masks: Whether it is allowed (n, actions); at least one in each row is.
    """
    return [int(k) for k in np.where(masks, values, -np.inf).argmax(axis=1)]


def shares(logits: FloatArray, masks: NDArray[np.bool_]) -> FloatArray:
    """Return the probabilities of a policy (n, actions); what is not allowed has none."""
    if not len(logits):
        return logits
    allowed = np.where(masks, logits, -np.inf)
    weights = np.exp(allowed - allowed.max(axis=1, keepdims=True))
    return np.asarray(weights / weights.sum(axis=1, keepdims=True), dtype=np.float32)
