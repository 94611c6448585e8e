"""The ring of transitions."""

import numpy as np

from codriving.training.nstep import Transition
from codriving.training.replay import Replay


def transition(k: int) -> Transition:
    mask = np.array([True, k % 2 == 0])
    return Transition(np.full(3, k, np.float32), k % 2, k / 10, 0.5, np.full(3, k + 1, np.float32), mask)


def filled(count: int, capacity: int = 5) -> Replay:
    made = Replay(capacity, 3, 2)
    for k in range(count):
        made.add(transition(k))
    return made


def held(replay: Replay) -> set[int]:
    return {int(k) for k in replay.state()["observations"][:, 0]}


def test_the_oldest_go_first() -> None:
    assert held(filled(3)) == {0, 1, 2}
    assert len(filled(3)) == 3
    assert held(filled(8)) == {3, 4, 5, 6, 7}
    assert len(filled(8)) == 5


def test_batches_hold_whole_transitions_of_what_is_there() -> None:
    batch = filled(3).draw(200, np.random.default_rng(0))
    assert set(batch.observations[:, 0]) == {0, 1, 2}
    np.testing.assert_array_equal(batch.later, batch.observations + 1)
    np.testing.assert_array_equal(batch.actions, batch.observations[:, 0] % 2)
    np.testing.assert_allclose(batch.gains, batch.observations[:, 0] / 10)
    np.testing.assert_array_equal(batch.masks[:, 1], batch.actions == 0)
    assert set(batch.discounts) == {0.5}


def test_one_that_was_restored_goes_on_alike() -> None:
    for count in (3, 8):
        one, other = filled(count), Replay(5, 3, 2)
        other.restore(one.state())
        for replay in (one, other):
            replay.add(transition(50))
        draws = [replay.draw(64, np.random.default_rng(1)).observations for replay in (one, other)]
        np.testing.assert_array_equal(*draws)
