"""What is made of the times of whole batches; the only episodes driven here are two short ones."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from benchmarks import batches
from benchmarks.batches import THIS, Batch, batch
from benchmarks.goals import Row


def test_a_batch_is_timed_from_the_start_of_its_first_episode() -> None:
    taken = batch(THIS, 2, 1, ("scenario.time_limit=2",))
    assert 0 < taken.start < taken.whole
    assert 0 < taken.driving < taken.whole


def test_a_batch_that_leaves_too_little_is_no_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(batches.subprocess, "run", lambda *_, **__: None)
    with pytest.raises(RuntimeError, match="has left 0 of 3 records"):
        batch(tmp_path, 3, 1)


def test_sides_drive_by_turns_and_the_middle_time_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []
    times = iter([10.0, 4.0, 8.0, 20.0, 6.0, 9.0, 12.0, 5.0, 7.0])

    def fake(checkout: Path, episodes: int, workers: int, typed: tuple[str, ...] = ()) -> Batch:
        asked.append((checkout, episodes, workers, typed))
        return Batch(next(times), 0.5, 3.0)

    monkeypatch.setattr(batches, "batch", fake)
    rows = [(row.name, row.ours, row.other, row.goal) for row in batches.against(tmp_path)]
    assert rows == [("200 episodes, paper", 5.0, 12.0, 0.6), ("200 episodes, default", 8.0, 12.0, 0.6)]
    assert asked[:3] == [(tmp_path, 200, 2, ()), (THIS, 200, 2, ("suite=paper",)), (THIS, 200, 2, ())]
    assert len(asked) == 9


def test_two_workers_against_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(batches, "batch", lambda _, episodes, workers: Batch(0.0, workers / 2, episodes / workers))
    faster, start = batches.workers(40)
    assert (faster.ratio, faster.reached) == (2.0, True)
    assert (start.ours, start.ratio, start.reached) == (1.0, pytest.approx(1 / 1.5), True)


def test_memory_is_compared_with_a_tenth_of_the_episodes(monkeypatch: pytest.MonkeyPatch) -> None:
    class Growing:
        driven = 0

        def __enter__(self) -> "Growing":
            return self

        def __exit__(self, *_: object) -> None:
            return None

        def drive(self, seed: int) -> None:
            assert seed == 20_000 + self.driven
            self.driven += 1

        def memory(self) -> float:
            return 100.0 + self.driven

    def rows() -> Iterator[Row]:
        return batches.memory(30)

    monkeypatch.setattr(batches, "Side", lambda *_: Growing())
    (row,) = rows()
    assert (row.ours, row.other, row.reached) == (130.0, 103.0, False)
    Growing.driven = 0
    assert [row.other for row in batches.memory(4)] == [101.0], "fewer than ten"
