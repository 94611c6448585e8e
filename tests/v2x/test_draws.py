"""What chance does to messages: shares, bursts and delays as they are set, in whatever order one asks."""

import math

import numpy as np
import pytest
from hearing import channel_settings

from codriving.v2x.draws import Errors, Link

TICKS = 10_000


def bursts(lost: list[bool]) -> list[int]:
    """How many messages were lost in a row, each time."""
    text = "".join("x" if one else " " for one in lost)
    return [len(run) for run in text.split()]


@pytest.mark.parametrize(
    ("loss", "burst", "in_a_row"),
    [
        (0.01, 1.0, 1 / 0.99),  # Losses without memory come in a row, too
        (0.1, 3.0, 3.0),
        (0.3, 3.0, 3.0),
        (0.6, 1.0, 2.5),
        (0.9, 1.0, 10.0),
        (0.5, 20.0, 20.0),
    ],
)
def test_losses_have_the_share_and_the_length_that_are_set(loss: float, burst: float, in_a_row: float) -> None:
    lost = [
        math.isinf(link.delay(tick))
        for seed in range(5)
        for link in [Link(channel_settings(loss=loss, burst=burst), seed, "CAV1", "CAV2")]
        for tick in range(TICKS)
    ]
    assert np.mean(lost) == pytest.approx(loss, rel=0.12)
    assert np.mean(bursts(lost)) == pytest.approx(in_a_row, rel=0.1)


def test_nothing_is_lost_without_loss() -> None:
    link = Link(channel_settings(age=0.1), 1, "CAV1", "CAV2")
    assert {link.delay(tick) for tick in range(TICKS)} == {0.1}


def test_ages_are_spread_as_gamma_with_the_mean_that_is_set() -> None:
    link = Link(channel_settings(age=0.3, age_shape=2.0), 1, "CAV1", "CAV2")
    delays = np.array([link.delay(tick) for tick in range(TICKS)])
    assert delays.mean() == pytest.approx(0.3, rel=0.03)
    # Of a Gamma distribution with shape 2 the standard deviation is the mean over the root of 2; 59.4 % are below it.
    assert delays.std() == pytest.approx(0.2121, rel=0.05)
    assert np.mean(delays < 0.3) == pytest.approx(0.594, abs=0.02)


def test_each_link_and_each_direction_is_drawn_for_itself() -> None:
    settings = channel_settings(loss=0.5, burst=2.0)
    pairs = [(1, "CAV1", "CAV2"), (1, "CAV2", "CAV1"), (1, "CAV1", "CAV3"), (2, "CAV1", "CAV2")]
    lost = [[math.isinf(Link(settings, *pair).delay(tick)) for tick in range(400)] for pair in pairs]
    # The first tick asks for the first block only, and what is asked last does not change what was drawn.
    for one, other in ((a, b) for k, a in enumerate(lost) for b in lost[:k]):
        assert 0.3 < np.mean(np.array(one) == np.array(other)) < 0.7


def test_draws_do_not_depend_on_the_order_in_which_they_are_asked_for() -> None:
    settings = channel_settings(age=0.3, age_shape=2.0, loss=0.3, burst=3.0, noise=1.0, speed_noise=0.5)
    there, back = Link(settings, 4, "CAV1", "CAV2"), Link(settings, 4, "CAV1", "CAV2")
    ticks = [900, 3, 300, 0, 511, 512]
    assert [there.delay(tick) for tick in ticks] == [back.delay(tick) for tick in reversed(ticks)][::-1]
    errors, later = (Errors(settings, 4, "CAV1", "HDV1") for _ in range(2))
    assert [errors.at(tick) for tick in ticks] == [later.at(tick) for tick in reversed(ticks)][::-1]


def test_noise_is_cut_off_at_three_standard_deviations() -> None:
    errors = Errors(channel_settings(noise=2.0, speed_noise=0.5), 1, "CAV1", "HDV1")
    drawn = np.array([errors.at(tick) for tick in range(TICKS)])
    assert np.abs(drawn[:, :2]).max() == 6.0
    assert np.abs(drawn[:, 2]).max() == 1.5
    assert drawn.std(axis=0) == pytest.approx([2.0, 2.0, 0.5], rel=0.03)
    assert np.abs(drawn.mean(axis=0)).max() < 0.06
