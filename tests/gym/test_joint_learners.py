"""The page on libraries for learning: its examples run where the library is there, and observations suit it."""

import re
import warnings
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from gymnasium.wrappers import FlattenObservation

from codriving.config.choices import choices
from codriving.gym.registration import env_id

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "learners.md").read_text(encoding="utf-8")
EXAMPLES = dict(
    zip(re.findall(r"^## (.*)", PAGE, re.M), re.findall(r"^```python\n(.*?)^```", PAGE, re.M | re.S), strict=True)
)


@pytest.mark.parametrize("scenario", ["intersection", "merge"])
def test_flat_observations_are_vectors_within_their_bounds(scenario: str) -> None:
    env = FlattenObservation(gymnasium.make(f"codriving.gym:{env_id(scenario)}", cavs=3, normalise=True))
    space = env.observation_space
    assert (space.shape, space.dtype) == ((3 * 8 * 6,), np.float32)
    observation, _ = env.reset(seed=1)
    assert space.contains(observation)
    assert space.contains(env.step(env.action_space.sample())[0])


@pytest.mark.parametrize("scenario", choices("scenario"))
def test_the_checker_of_stable_baselines_is_silent(scenario: str) -> None:
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    env = gymnasium.make(f"codriving.gym:{env_id(scenario)}")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        checker.check_env(FlattenObservation(env))
    with pytest.warns(UserWarning, match="image"):
        checker.check_env(env)


@pytest.mark.parametrize(
    ("library", "module"),
    [("Stable-Baselines3", "stable_baselines3"), ("sb3-contrib", "sb3_contrib"), ("TorchRL", "torchrl")],
)
def test_the_example_runs(library: str, module: str, capsys: pytest.CaptureFixture[str]) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pytest.importorskip(module)
        exec(EXAMPLES[library], {})
    said = capsys.readouterr().out
    assert re.search(r"torch\.Size\(\[5, 4, 8, 6\]\)|(success|collision|off_road|timeout) (\(|0)", said)
