"""Whole trainings of a single vehicle, small: the same bytes for one seed, also if they were stopped on the way."""

import io
import sys
from pathlib import Path

import pytest

pytest.importorskip("torch")
pytest.importorskip("stable_baselines3")

from codriving.methods.learned.weights import load
from codriving.training.display import Display
from codriving.training.folder import Stop, open_folder
from codriving.training.run import train

HERE = str(Path(__file__).parent)
if HERE not in sys.path:
    sys.path.insert(0, HERE)

from lone import lone, lone_config  # noqa: E402  (needs the path above)

FILES = ("safetensors", "json")


class After(Stop):
    """Wants to stop once it has been asked some times."""

    def __init__(self, times: int) -> None:
        super().__init__()
        self._left = times

    @property
    def wanted(self) -> bool:
        """Whether it is time."""
        self._left -= 1
        return self._left < 0

    @wanted.setter
    def wanted(self, value: bool) -> None:
        """Nothing; it counts."""


def run(path: Path, learner: str, *overrides: str, stop: Stop | None = None) -> Path:
    """Train in a folder, or go on in it."""
    config, out = lone_config(learner, *overrides), io.StringIO()
    with open_folder(path, f"{learner}_junction", f"codriving train {learner}", config) as folder:
        return train(lone(learner, *overrides), folder, Display("lone", 96, out), stop or Stop())


@pytest.fixture(scope="module", params=["ppo", "tell"])
def finished(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path]:
    """A learner, and the folder of a training of it that went through."""
    path = tmp_path_factory.mktemp(request.param)
    run(path, request.param)
    return request.param, path


def test_it_leaves_weights_a_curve_and_who_taught(finished: tuple[str, Path]) -> None:
    learner, path = finished
    purpose = load(path / f"{learner}_junction.safetensors").purpose
    assert (purpose.method, purpose.hidden) == (learner, (8,))
    assert purpose.form == {"ppo": "perceptron", "tell": "attention"}[learner]
    assert purpose.training.get("teacher") == {"ppo": None, "tell": "rules"}[learner]
    rows = (path / "curve.csv").read_text().splitlines()
    assert rows[0].startswith("decisions,updates,rate,train_success")
    assert ("pull" in rows[0].split(",")) == (learner == "tell")
    assert [row.split(",")[:2] for row in rows[1:]] == [["64", "2"], ["96", "3"]]
    assert (path / "curve.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("rollouts", [1, 2])
def test_a_training_that_was_stopped_ends_with_the_same_bytes(
    finished: tuple[str, Path], tmp_path: Path, rollouts: int
) -> None:
    learner, path = finished
    with pytest.raises(KeyboardInterrupt):
        run(tmp_path, learner, stop=After(rollouts))
    run(tmp_path, learner)
    for name in (*(f"{learner}_junction.{kind}" for kind in FILES), "curve.csv", "curve.png", "finalists.csv"):
        assert (tmp_path / name).read_bytes() == (path / name).read_bytes(), name


def test_another_seed_gives_other_weights(finished: tuple[str, Path], tmp_path: Path) -> None:
    learner, path = finished
    best = run(tmp_path, learner, "seed=2")
    assert best.read_bytes() != (path / best.name).read_bytes()


def test_a_teacher_makes_a_difference_as_long_as_it_pulls(tmp_path: Path) -> None:
    names = ("some", "more", "none")
    for name, pull in zip(names, (1.0, 5.0, 0.0), strict=True):
        run(tmp_path / name, "tell", f"guidance.pull.start={pull}")
    found = {(tmp_path / name / "states" / "000000064.safetensors").read_bytes() for name in names}
    assert len(found) == 3
