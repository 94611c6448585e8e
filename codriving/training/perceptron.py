"""Linear layers with rectifiers between them, in PyTorch."""

from collections.abc import Sequence
from itertools import pairwise

from torch import nn


def perceptron(sizes: Sequence[int]) -> nn.Sequential:
    """Return a multilayer perceptron.

    Args:
        sizes: Number of inputs, of units in each hidden layer, and of outputs.
    """
    layers: list[nn.Module] = []
    for inputs, outputs in pairwise(sizes):
        layers += [nn.Linear(inputs, outputs), nn.ReLU()]
    return nn.Sequential(*layers[:-1])
