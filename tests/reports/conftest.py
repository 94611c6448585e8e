"""Builders of records with nothing in them but what a test is about."""

from collections.abc import Callable

import pytest

from codriving.datatypes.record import (
    Collision,
    Ending,
    EpisodeRecord,
    NamedNumber,
    Outcome,
    Participant,
    Pet,
    Score,
    TravelScore,
)

Make = Callable[..., EpisodeRecord]


@pytest.fixture
def make() -> Make:
    def record(
        seed: int,
        ending: Ending = Ending.SUCCESS,
        pets: tuple[float, ...] = (),
        velocities: tuple[float, ...] = (),
        variant: str = "full",
        scenario: str = "intersection",
        pair: str = "CAV-HDV",
        counts: dict[str, int | float] | None = None,
        delay: float | None = 1.0,
        method: str = "codriving",
        reasoner: str = "rules",
        clean: bool | None = None,
        time: float | None = None,
    ) -> EpisodeRecord:
        hit = Collision(3.0, "CAV0", "HDV0", pair) if ending is Ending.COLLISION else None
        score = Score(
            ending is Ending.SUCCESS,
            tuple(Pet("CAV0", "CAV1", "crossing", pet) for pet in pets),
            tuple(TravelScore(f"CAV{i}", velocity, 10.0, delay) for i, velocity in enumerate(velocities)),
            () if time is None else (NamedNumber("time_all", time, "s", "lower"),),
            clean=clean,
        )
        return EpisodeRecord(
            scenario=scenario,
            method=method,
            variant=variant,
            reasoner=reasoner,
            seed=seed,
            outcome=Outcome(ending, 12.0, {}, hit, message="RuntimeError: x" if ending is Ending.ERROR else ""),
            scores={} if ending is Ending.ERROR else {"standard": score},
            participants=(Participant("CAV0", "CAV", "a", None), Participant("HDV0", "HDV", "b", None)),
            decisions=12,
            counts=counts or {},
        )

    return record
