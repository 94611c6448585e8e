"""The judge that was fitted: what it is fitted to, its thresholds, and files that hold no coefficients."""

import json
from pathlib import Path

import numpy as np
import pytest
from worlds import Junction, car

from codriving.errors import ConfigError
from codriving.judgement.contests import FEATURES, contests
from codriving.judgement.learned import OURS, FittedJudge, fit


def written(folder: Path, **changed: object) -> Path:
    """A file with one weight, and what is changed in it."""
    file = folder / "mine.json"
    file.write_text(
        json.dumps({"weights": {"time_ahead": 2.0}, "bias": -1.0, **changed}),
        encoding="utf-8",
    )
    return file


def test_a_fit_finds_what_made_the_answers() -> None:
    rng = np.random.default_rng(7)
    rows = rng.normal([3.0, -1.0], [2.0, 0.5], (20_000, 2))
    truth = (rng.random(20_000) < 1 / (1 + np.exp(-(0.5 + 0.8 * rows[:, 0] - 1.5 * rows[:, 1])))).astype(float)
    weights, bias = fit(rows, truth)
    assert weights == pytest.approx([0.8, -1.5], abs=0.12)
    assert bias == pytest.approx(0.5, abs=0.12)


def test_a_number_that_never_changes_weighs_nothing() -> None:
    rows = np.array([[1.0, 0.0], [1.0, 1.0], [1.0, 0.2], [1.0, 0.9]])
    weights, _ = fit(rows, np.array([0.0, 1.0, 0.0, 1.0]))
    assert weights[0] == 0.0
    assert weights[1] > 0.1


@pytest.mark.parametrize(
    ("above", "below", "expected"),
    [(0.5, 0.5, "yields"), (0.63, 0.61, "unclear"), (0.63, 0.63, "goes")],
)
def test_thresholds(above: float, below: float, expected: str, tmp_path: Path, junction: Junction) -> None:
    world = junction.world(car("CAV1", "east-west", 80.0, 8.0, 9.0), car("HDV1", "south-north", 76.0, 8.0))
    [contest] = contests(junction.think(world).moment())
    judge = FittedJudge(written(tmp_path), above, below)
    # The driver is there 0.745 s after the CAV: 1 / (1 + exp(1 - 2 * 0.745)).
    judged = judge.judge([contest])["CAV1", "HDV1"]
    assert judged.yields == pytest.approx(0.620, abs=0.001)
    assert judged.answer == expected


def test_ours_was_fitted_on_seeds_of_trainings_and_weighs_every_number() -> None:
    told = json.loads(OURS.read_text(encoding="utf-8"))
    assert list(told["weights"]) == list(FEATURES)
    assert all(int(word) > 1_000_000 for seeds in told["seeds"].values() for word in seeds.split(" to "))
    assert told["moments"] > 400
    assert told["date"] >= "2026-01-01"
    assert FittedJudge(None, 0.5, 0.5).files() == {"coefficients": OURS}


def test_thresholds_do_not_cross_and_are_probabilities() -> None:
    with pytest.raises(ConfigError, match=r"goes_below must be at most yields_above, got 0.6, 0.4"):
        FittedJudge(None, 0.4, 0.6)
    with pytest.raises(ConfigError, match=r"yields_above must be 0 to 1, got 1.1"):
        FittedJudge(None, 1.1, 0.6)


@pytest.mark.parametrize(
    ("changed", "why"),
    [
        ({"weights": {"mood": 1.0}}, "weighs mood, which are no numbers of a pair"),
        ({"weights": 3}, "holds no coefficients"),
        ({"bias": float("nan")}, "holds a weight that is no number"),
        ({"bias": None}, "holds no coefficients"),
    ],
)
def test_a_file_that_holds_none_is_refused(changed: dict[str, object], why: str, tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=why):
        FittedJudge(written(tmp_path, **changed), 0.5, 0.5)
    with pytest.raises(ConfigError, match=r"gone.json holds no coefficients"):
        FittedJudge(tmp_path / "gone.json", 0.5, 0.5)
