"""One record with everything in it, and makes ``manifests`` importable."""

import sys
from pathlib import Path

import pytest

from codriving.datatypes.record import Collision, Ending, EpisodeRecord, Outcome, Participant, Pet, Score, TravelScore

HERE = str(Path(__file__).parent)
if HERE not in sys.path:
    sys.path.insert(0, HERE)


@pytest.fixture
def record() -> EpisodeRecord:
    hit = Collision(4.2, "CAV1", "HDV2", "CAV-HDV")
    return EpisodeRecord(
        scenario="intersection",
        method="codriving",
        variant="no_negotiation/own_view",
        reasoner="rules",
        seed=7,
        outcome=Outcome(Ending.COLLISION, 4.2, {"CAV0": 3.0}, hit, (hit,), ("HDV3",), ""),
        scores={
            "standard": Score(False, (Pet("CAV0", "CAV1", "crossing", 1.25),), (TravelScore("CAV0", 7.1, 3.0, None),))
        },
        participants=(Participant("CAV0", "CAV", "south-north", 3.0), Participant("HDV2", "HDV", "west-east", None)),
        decisions=5,
        counts={"fallbacks": 2},
    )
