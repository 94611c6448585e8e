"""A whole training, small: the same seed gives the same bytes, also if it was stopped on the way."""

import io
import sys
from pathlib import Path

import pytest

pytest.importorskip("torch")

from codriving.errors import RunFolderError, TrainingError
from codriving.methods.learned.weights import load, sidecar
from codriving.training.display import Display
from codriving.training.folder import Stop, open_folder
from codriving.training.run import train

HERE = str(Path(__file__).parent)
if HERE not in sys.path:
    sys.path.insert(0, HERE)

from tiny import tiny, tiny_config  # noqa: E402  (needs the path above)


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


def run(path: Path, *overrides: str, stop: Stop | None = None) -> Path:
    """Train in a folder, or go on in it."""
    config = tiny_config(*overrides)
    out = io.StringIO()
    with open_folder(path, "madqn_junction", "codriving train madqn", config) as folder:
        return train(tiny(*overrides), folder, Display("tiny", 160, out), stop or Stop())


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a training that went through."""
    path = tmp_path_factory.mktemp("through")
    run(path)
    return path


def test_it_leaves_weights_a_curve_and_a_picture(finished: Path) -> None:
    trained = load(finished / "madqn_junction.safetensors")
    assert trained.purpose.hidden == (8,)
    assert trained.purpose.target_speeds == ((0.0, 3.0, 6.0, 9.0),)
    assert trained.purpose.training["seed"] == 1
    assert trained.purpose.world == {"limits": "road", "drivers": "mixed"}
    rows = (finished / "curve.csv").read_text().splitlines()
    assert rows[0].startswith("decisions,episodes,updates,epsilon,loss,train_success,score,intersection_4.success")
    assert len(rows) >= 1 + 2, "once in the middle, and at the end"
    assert int(rows[-1].split(",")[0]) >= 160
    assert (finished / "curve.png").read_bytes().startswith(b"\x89PNG")
    assert len((finished / "finalists.csv").read_text().splitlines()) == 3


@pytest.mark.parametrize("episodes", [1, 4])
def test_a_training_that_was_stopped_ends_with_the_same_bytes(finished: Path, tmp_path: Path, episodes: int) -> None:
    with pytest.raises(KeyboardInterrupt):
        run(tmp_path, stop=After(episodes))
    assert not (tmp_path / "madqn_junction.safetensors").exists()
    best = run(tmp_path)
    for name in ("madqn_junction.safetensors", "madqn_junction.json", "curve.csv", "curve.png", "finalists.csv"):
        assert (tmp_path / name).read_bytes() == (finished / name).read_bytes(), name
    assert sidecar(best).exists()


def test_another_seed_gives_other_weights(finished: Path, tmp_path: Path) -> None:
    best = run(tmp_path, "seed=2")
    assert best.read_bytes() != (finished / "madqn_junction.safetensors").read_bytes()


def test_a_folder_of_another_training_is_refused(finished: Path) -> None:
    with pytest.raises(RunFolderError, match="other settings"):
        run(finished, "seed=2")


def test_a_damaged_checkpoint_is_refused_in_a_line(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt):
        run(tmp_path, stop=After(1))
    (tmp_path / "checkpoint" / "state.json").write_text("{")
    with pytest.raises(TrainingError, match="checkpoint"):
        run(tmp_path)
