"""Gymnasium knows our scenarios, whichever of the two is imported first, and is not imported by us alone."""

import subprocess
import sys
from pathlib import Path

import gymnasium
import pytest

from codriving.config.choices import choices
from codriving.gym.registration import env_id, register_scenarios

REPOSITORY = Path(__file__).resolve().parents[2]


def run(code: str) -> str:
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code], cwd=REPOSITORY, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_every_scenario_is_registered() -> None:
    assert {env_id(name) for name in choices("scenario")} <= set(gymnasium.registry)


@pytest.mark.parametrize("imports", ["import codriving, gymnasium", "import gymnasium, codriving"])
def test_either_order_of_imports_will_do(imports: str) -> None:
    assert run(f"{imports}; print(gymnasium.spec('codriving/intersection-v0').id)") == "codriving/intersection-v0"


def test_importing_us_alone_imports_nothing_heavy() -> None:
    heavy = "{'gymnasium', 'pettingzoo', 'numpy', 'highway_env', 'hydra', 'pandas'}"
    assert run(f"import sys, codriving; print(sorted({heavy} & set(sys.modules)))") == "[]"


def test_who_only_looks_for_gymnasium_does_no_harm() -> None:
    """The package is left as it would be without us: loader, resources and source."""
    code = """
import codriving, sys
from importlib.util import find_spec
from importlib.resources import files
find_spec("gymnasium"); find_spec("gymnasium")
import gymnasium, inspect
assert "codriving/intersection-v0" in gymnasium.registry
assert not [finder for finder in sys.meta_path if "codriving" in type(finder).__module__]
assert "exec_module" not in vars(gymnasium.__spec__.loader)
assert files("gymnasium").joinpath("__init__.py").is_file() and inspect.getsource(gymnasium)
print("ok")
"""
    assert run(code) == "ok"


def test_scenarios_of_the_user_are_registered_on_request(tmp_path: Path) -> None:
    (tmp_path / "scenario").mkdir()
    text = choices("scenario")["intersection"].read_text()
    (tmp_path / "scenario" / "registered_by_test.yaml").write_text(text)
    name = env_id("registered_by_test")
    register_scenarios(tmp_path)
    register_scenarios(tmp_path)
    try:
        env = gymnasium.make(name, cavs=3)
        assert env.reset(seed=0)[0].shape == (3, 8, 6)
    finally:
        del gymnasium.registry[name]
