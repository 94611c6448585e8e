"""The kinds of trained networks, and how each is laid out in a file."""

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from codriving.methods.learned.attention import OWN, WIDTH, Attention
from codriving.methods.learned.layout import SLOT, SLOTS
from codriving.methods.learned.network import FloatArray, Network

PERCEPTRON, ATTENTION = "perceptron", "attention"
FORMS = (PERCEPTRON, ATTENTION)

AnyNetwork: TypeAlias = Network | Attention


def shapes(form: str, inputs: int, hidden: Sequence[int], outputs: int) -> dict[str, tuple[int, ...]]:
    """Return the shape of every tensor of a network, by name.

    Args:
        form: One of ``FORMS``.
    """
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
    """Put a network together.

    Args:
        form: One of ``FORMS``.
        found: Its tensors by name, in the shapes of ``shapes``.
    """
    layers = range(sum(1 for name in found if name[0] == "W"))
    judge = Network([found[f"W{k}"] for k in layers], [found[f"b{k}"] for k in layers])
    if form == PERCEPTRON:
        return judge
    return Attention({name: (found[f"{name}.W"], found[f"{name}.b"]) for name in Attention.LAYERS}, judge)
