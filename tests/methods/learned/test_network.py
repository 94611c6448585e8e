"""The network in numpy: layers, rectifiers, and the choice among what is allowed."""

import numpy as np
import pytest

from codriving.methods.learned.network import Network, greedy


def test_a_network_by_hand() -> None:
    first = np.array([[1.0, -1.0], [0.0, 2.0]], np.float32)
    last = np.array([[1.0], [10.0]], np.float32)
    network = Network([first, last], [np.array([0.5, 0.0], np.float32), np.array([-1.0], np.float32)])
    # Hidden: (1.5, -1 + 2 * 3 = 5) and (-0.5 -> 0, 1 -> 1).
    np.testing.assert_allclose(network(np.array([[1.0, 3.0], [-1.0, 0.0]], np.float32)), [[50.5], [9.0]])


def test_only_allowed_actions_are_chosen() -> None:
    values = np.array([[3.0, 2.0, 1.0], [1.0, 1.0, 0.0], [-5.0, -4.0, -6.0]], np.float32)
    masks = np.array([[False, True, True], [True, True, True], [True, False, True]])
    assert greedy(values, masks) == [1, 0, 0]


@pytest.mark.parametrize("seed", [0, 1])
def test_numpy_and_torch_agree(seed: int) -> None:
    pytest.importorskip("torch")
    import torch

    from codriving.training.double_dqn import DoubleDqn, as_numpy

    learner = DoubleDqn((44, 128, 128, 3), 0.01, 10.0, seed)
    observations = np.random.default_rng(seed).uniform(-1, 1, (2000, 44)).astype(np.float32)
    for live in (True, False):
        with torch.no_grad():
            expected = learner.online(torch.from_numpy(observations)).numpy()
        np.testing.assert_allclose(as_numpy(learner.online, live)(observations), expected, atol=1e-5)
