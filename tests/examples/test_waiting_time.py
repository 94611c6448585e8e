"""The example of a metric of one's own: built from its YAML, its numbers are those of a known drive."""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codriving.config.build import build
from codriving.config.compose import compose
from codriving.datatypes.parts import Metric
from codriving.datatypes.record import Ending, Outcome, Track, Trajectory
from codriving.datatypes.world import Kind

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "waiting_time"
GUIDE = Path(__file__).resolve().parents[2] / "CONTRIBUTING.md"


@pytest.fixture
def metric(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    monkeypatch.syspath_prepend(str(FOLDER))
    config = compose(["metrics=waiting_time"], FOLDER / "conf")
    yield build(config["metrics"], Metric, "metrics", config["plugins"])
    sys.modules.pop("waiting_time", None)


def track(name: str, x: list[float], y: float, speed: list[float], first_step: int = 0) -> Track:
    zeros = np.zeros(len(x))
    return Track(
        name,
        Kind.CAV if name.startswith("CAV") else Kind.HDV,
        "r",
        first_step,
        np.array(x),
        zeros + y,
        zeros,
        np.array(speed),
        zeros,
        ("",) * len(x),
        None,
    )


def test_standing_time_and_smallest_distance_are_measured(metric: Any) -> None:
    one = track("CAV0", [0.0, 1.0, 1.0, 1.0], 0.0, [5.0, 0.4, 0.0, 6.0])
    # It is on the road from the third row on, so that their distances are 4 m and 5 m.
    other = track("HDV0", [1.0, 4.0], 4.0, [0.0, 0.0], first_step=2)
    score = metric.score(Trajectory(0.1, (one, other)), Outcome(Ending.SUCCESS, 0.4, {}), None)
    assert score.success
    assert {number.name: number.value for number in score.numbers} == {
        "waiting_time": pytest.approx(0.2),
        "smallest_distance": 4.0,
    }


def test_of_one_vehicle_there_is_no_distance(metric: Any) -> None:
    alone = track("CAV0", [0.0, 1.0], 0.0, [5.0, 5.0])
    score = metric.score(Trajectory(0.1, (alone,)), Outcome(Ending.TIMEOUT, 0.2, {}), None)
    assert [number.value for number in score.numbers] == [0.0, None]


def test_the_guide_names_it() -> None:
    assert "examples/waiting_time" in GUIDE.read_text(encoding="utf-8")
