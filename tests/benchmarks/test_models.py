"""Arithmetic of the benchmarks of language models, and how benchmarks are chosen; nothing is measured here."""

import numpy as np
import pytest

from benchmarks import model_batch, model_questions, model_steps, worlds
from benchmarks.__main__ import found, main
from codriving.datatypes.record import Track, Trajectory
from codriving.datatypes.world import Kind


def test_the_middle_step_counts_against_two_calls() -> None:
    assert model_steps.ratio([0.5, 0.42, 9.0], 0.2) == pytest.approx(1.25)
    assert set(model_steps.STEPS) == set(model_steps.GOALS)


def test_the_longest_episode_is_driven_alone() -> None:
    assert model_batch.longest({3: 7.0, 2: 9.0, 1: 9.0, 0: 1.0}) == 1


def test_what_is_asked_is_shared_among_all_steps() -> None:
    def line(purpose: str, *words: int) -> dict[str, object]:
        return {"purpose": purpose, "calls": [{"messages": [{"content": "word " * number}]} for number in words]}

    asked = [line("negotiate", 97), line("decide", 47, 57), line("decide", 47)]
    row = model_questions.summary(asked, 4, lambda text: len(text.split()))
    assert (row["calls"], row["calls_share"]) == (1.0, 0.2)
    assert (row["tokens"], row["tokens_share"]) == (65, 0.015)
    assert (row["order_tokens"], row["decision_tokens"]) == (100, 53)
    assert row["full_step_tokens"] == round(100 + 4 * 160 / 3)


def test_no_question_is_nothing() -> None:
    row = model_questions.summary([], 4, len)
    assert (row["calls"], row["tokens"], row["full_step_tokens"]) == (0, 0, 0)


def test_largest_accelerations_are_those_of_any_vehicle() -> None:
    zero = np.zeros(3)
    turning = Track("a", Kind.CAV, "r", 0, zero, zero, np.array([0.0, 0.02, 0.05]), np.array([5.0, 10.0, 8.0]),
                    np.array([1.0, -3.0, 0.0]), ("IDLE",) * 3, None)  # fmt: skip
    braking = Track("b", Kind.HDV, "r", 0, zero, zero, zero, zero, np.array([2.0, -6.0, 0.0]), ("",) * 3, None)
    # 0.03 rad in 0.1 s at 10 m/s.
    assert worlds.largest(Trajectory(0.1, (turning, braking))) == pytest.approx((6.0, 2.0, 3.0))


def test_only_what_is_named_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    assert {"environment", "model_steps", "model_batch", "model_questions"} <= set(found())
    ran: list[list[str]] = []
    monkeypatch.setattr(model_steps, "main", ran.append)
    main(["--only", "model_steps", "--json"])
    assert ran == [["--json"]]
    with pytest.raises(SystemExit):
        main(["--only", "no_such_benchmark"])
