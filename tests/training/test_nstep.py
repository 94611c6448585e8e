"""Transitions over several steps: sums, ends and what is dropped."""

from collections.abc import Iterator

import numpy as np
import pytest

from codriving.datatypes.record import Ending
from codriving.training.episode import AgentStep
from codriving.training.nstep import Trail, Transition

GAMMA = 0.5
MASK = np.array([True, True, False])


def seen(k: int) -> np.ndarray[tuple[int], np.dtype[np.float32]]:
    return np.full(2, k, np.float32)


def trail(rewards: list[float], steps: int = 3) -> tuple[Trail, list[Transition]]:
    """A trail with rewards, observations counted from 0, and the full transitions so far."""
    made, found = Trail(steps, GAMMA), []
    for k, reward in enumerate(rewards):
        made.add(seen(k), MASK, k % 3, reward)
        if k < len(rewards) - 1:
            found += made.full(seen(k + 1), MASK)
    return made, found


def plain(transitions: list[Transition]) -> list[tuple[float, int, float, float, float]]:
    """First observation, action, gain, discount and last observation."""
    return [(float(t.observation[0]), t.action, t.gain, t.discount, float(t.later[0])) for t in transitions]


def test_full_transitions_sum_discounted_rewards() -> None:
    _, found = trail([1.0, 2.0, 4.0, 8.0, 16.0])
    assert plain(found) == [(0, 0, 1 + 1 + 1, 0.125, 3), (1, 1, 2 + 2 + 2, 0.125, 4)]


def test_an_end_leaves_shorter_sums_and_nothing_after_them() -> None:
    made, _ = trail([1.0, 2.0, 4.0, 8.0])
    ended = made.ended()
    assert [(t.action, t.gain, t.discount) for t in ended] == [(1, 2 + 2 + 2, 0), (2, 4 + 4, 0), (0, 8, 0)]
    assert made.ended() == []


def test_a_time_limit_is_no_end() -> None:
    made, _ = trail([1.0, 2.0, 4.0, 8.0])
    assert plain(made.cut(seen(9), MASK)) == [(1, 1, 6, 0.125, 9), (2, 2, 8, 0.25, 9), (3, 0, 8, 0.5, 9)]


def test_the_last_step_of_a_bystander_is_dropped() -> None:
    made, _ = trail([1.0, 2.0, 4.0, -99.0])
    assert plain(made.dropped()) == [(1, 1, 4, 0.25, 3), (2, 2, 4, 0.5, 3)]
    made, _ = trail([-99.0])
    assert made.dropped() == []


def remembered(step: AgentStep, trails: dict[str, Trail], steps: int, discount: float) -> Iterator[Transition]:
    """What the trainer makes of a step."""
    pytest.importorskip("torch")
    from codriving.training.trainer import remember

    return remember(step, trails, steps, discount)


def moment(
    ending: Ending | None, arrived: str = "", failed: str = "", rewards: tuple[float, ...] = (0.0,) * 3
) -> AgentStep:
    names = ["A", "B", "C"]
    later = {name: seen(k + 100) for k, name in enumerate(names) if name not in arrived}
    return AgentStep(
        names,
        np.stack([seen(k) for k in range(3)]),
        np.stack([MASK] * 3),
        [0, 1, 2],
        list(rewards),
        frozenset(arrived),
        frozenset(failed),
        ending,
        later,
        dict.fromkeys(later, MASK),
    )


def test_who_arrives_stops_while_the_others_go_on() -> None:
    trails: dict[str, Trail] = {}
    found = list(remembered(moment(None, arrived="B", rewards=(0.0, 1.0, 0.0)), trails, 1, GAMMA))
    assert [(t.action, t.gain, t.discount) for t in found] == [(0, 0, GAMMA), (1, 1, 0), (2, 0, GAMMA)]


def test_a_crash_is_blamed_on_those_who_are_in_it() -> None:
    trails: dict[str, Trail] = {}
    assert list(remembered(moment(None), trails, 2, GAMMA)) == []
    found = list(remembered(moment(Ending.COLLISION, failed="AC", rewards=(-3.0, 0.5, -3.0)), trails, 2, GAMMA))
    assert [(t.action, t.gain, t.discount) for t in found] == [
        (0, -1.5, 0), (0, -3.0, 0), (1, 0.0, GAMMA), (2, -1.5, 0), (2, -3.0, 0),
    ]  # fmt: skip


def test_the_time_limit_bootstraps_for_all_agents() -> None:
    found = list(remembered(moment(Ending.TIMEOUT), {}, 2, GAMMA))
    assert [(t.action, t.discount, t.later[0]) for t in found] == [(0, 0.5, 100), (1, 0.5, 101), (2, 0.5, 102)]


@pytest.mark.parametrize("steps", [1, 2, 4])
def test_every_decision_is_the_first_of_exactly_one_transition(steps: int) -> None:
    made, found = trail([1.0] * 7, steps)
    assert len(found) + len(made.ended()) == 7
