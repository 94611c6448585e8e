"""The policy of a single learner: what is forbidden is never drawn, a teacher pulls, and numpy computes the same."""

from math import log

import numpy as np
import pytest

torch = pytest.importorskip("torch")
pytest.importorskip("stable_baselines3")

from gymnasium.spaces import Box, Discrete  # noqa: E402  (needs the skip above)

from codriving.methods.learned.layout import (  # noqa: E402
    ACTIONS,
    FAMILIES,
    JUNCTION,
    SLOT,
    SLOTS,
    feature_count,
)
from codriving.methods.learned.network import ATTENTION, FORMS, network_of, shapes, tensors  # noqa: E402
from codriving.training.policy import SURE, DriverPolicy, actor_as_numpy  # noqa: E402

FEATURES, OUTPUTS = feature_count(JUNCTION), len(ACTIONS[JUNCTION])


def policy(form: str, family: str = JUNCTION) -> DriverPolicy:
    torch.manual_seed(0)
    features, outputs = feature_count(family), len(ACTIONS[family])
    space = Box(-1.0, 1.0, (features + 2 * outputs,), np.float32)
    made = DriverPolicy(
        space, Discrete(outputs), lambda _: 1e-3, features=features, hidden=(16, 8), attends=form == ATTENTION
    )
    with torch.no_grad():
        for parameter in made.parameters():
            parameter.add_(0.3 * torch.randn_like(parameter))
    return made


def rows(mask: list[int], advice: list[int], count: int = 200) -> "torch.Tensor":
    seen = torch.rand(count, FEATURES) * 2 - 1
    return torch.cat([seen, torch.tensor([mask + advice], dtype=torch.float32).expand(count, -1)], 1)


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("form", FORMS)
def test_numpy_computes_the_same(form: str, family: str) -> None:
    actor = policy(form, family).actor
    rng = np.random.default_rng(0)
    seen = rng.uniform(-1, 1, (1000, feature_count(family))).astype(np.float32)
    first = 8
    for slot in range(SLOTS):
        there = rng.random(1000) < 0.5
        seen[:, first + slot * len(SLOT)] = there
        seen[~there, first + slot * len(SLOT) : first + (slot + 1) * len(SLOT)] = 0
    with torch.no_grad():
        wanted = actor(torch.from_numpy(seen)).numpy()
    network = actor_as_numpy(actor)
    np.testing.assert_allclose(network(seen), wanted, atol=1e-5)
    held = tensors(network)
    assert {name: t.shape for name, t in held.items()} == shapes(form, feature_count(family), (16, 8), wanted.shape[1])
    np.testing.assert_array_equal(network_of(form, held)(seen), network(seen))


def test_who_is_not_there_is_not_attended_to() -> None:
    network = actor_as_numpy(policy(ATTENTION).actor)
    seen = np.random.default_rng(1).uniform(-1, 1, (50, FEATURES)).astype(np.float32)
    seen[:, 8 :: len(SLOT)][:, :SLOTS] = 0
    other = seen.copy()
    for slot in range(SLOTS):
        other[:, 9 + slot * len(SLOT) : 8 + (slot + 1) * len(SLOT)] = 0.5
    np.testing.assert_array_equal(network(seen), network(other))
    other[:, 8] = 1
    assert np.abs(network(seen) - network(other)).max() > 1e-3


@pytest.mark.parametrize("form", FORMS)
def test_what_is_forbidden_is_never_drawn(form: str) -> None:
    made = policy(form)
    actions, values, logs = made(rows([1, 0, 1], [0, 0, 0]))
    assert set(actions.tolist()) == {0, 2}
    assert values.shape == (200, 1)
    assert made.evaluate_actions(rows([1, 0, 1], [0, 0, 0]), actions)[1].shape == logs.shape
    again = made.evaluate_actions(rows([0, 1, 0], [0, 0, 0]), torch.ones(200))
    assert again[1].abs().max() < 1e-6, "where one is left it is certain"


def test_likelihoods_are_those_that_were_drawn_with() -> None:
    made, observed = policy("perceptron"), rows([1, 1, 1], [0, 0, 0])
    actions, _, logs = made(observed)
    torch.testing.assert_close(made.evaluate_actions(observed, actions)[1], logs)
    best = made(observed, deterministic=True)[0]
    assert torch.equal(best, made.actor(observed[:, :FEATURES]).argmax(1))


def test_the_divergence_is_that_of_a_sure_teacher() -> None:
    made = policy("perceptron")
    logs = torch.log(torch.tensor([[0.2, 0.3, 0.5]]))
    rest = (1 - SURE) / 2
    wanted = SURE * log(SURE / 0.5) + rest * log(rest / 0.2) + rest * log(rest / 0.3)
    assert made.divergence(rows([1, 1, 1], [0, 0, 1], 1), logs).item() == pytest.approx(wanted, abs=1e-5)
    alone = torch.log(torch.tensor([[1e-30, 1.0, 1e-30]]))
    assert made.divergence(rows([0, 1, 0], [0, 1, 0], 1), alone).item() == pytest.approx(0.0, abs=1e-5)
    assert made.divergence(rows([1, 1, 1], [0, 0, 0], 1), logs).item() == 0, "no advice, no pull"


def test_who_is_pulled_comes_to_do_as_the_teacher_says() -> None:
    made, observed = policy("perceptron"), rows([1, 1, 1], [0, 1, 0])
    made.pull = 100.0
    before = made.actor(observed[:, :FEATURES]).softmax(1)[:, 1].mean().item()
    for _ in range(200):
        made.optimizer.zero_grad()
        (-0.01 * made.evaluate_actions(observed, torch.zeros(200))[2].mean()).backward()
        made.optimizer.step()
    after = made.actor(observed[:, :FEATURES]).softmax(1)[:, 1].mean().item()
    assert after > max(before, 0.6)
    made.pull = 0.0
    shares = made.actor(observed[:, :FEATURES]).softmax(1)
    entropy = made.evaluate_actions(observed, torch.zeros(200))[2]
    torch.testing.assert_close(entropy, -(shares * shares.log()).sum(1))
