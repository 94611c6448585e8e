"""The environments of highway-env are imported by those who use them: they bring Matplotlib and pandas with them."""

import subprocess
import sys

import pytest

LEAN = """
import sys
import codriving.environment
assert "gymnasium" not in sys.modules
assert not {"pandas", "matplotlib", "pygame", "highway_env.envs"} & set(sys.modules)
"""

WHOLE = """
from codriving.environment.environment import Environment
import highway_env
import gymnasium
from highway_env.road.road import Road

made = gymnasium.make("highway-v0")
made.reset(seed=0)
assert type(made.unwrapped.road) is Road is highway_env.road.road.Road
assert highway_env.__version__
"""

FIRST = "import highway_env\n" + WHOLE


@pytest.mark.parametrize("code", [LEAN, WHOLE, FIRST], ids=["lean", "whole-afterwards", "whole-before"])
def test_environments_of_highway_env_come_with_their_first_use(code: str) -> None:
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
