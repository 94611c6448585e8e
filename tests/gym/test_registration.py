"""Gymnasium knows our scenarios once codriving.gym is imported, and is not imported by codriving alone."""

import subprocess
import sys
from pathlib import Path

import gymnasium
import pytest

from codriving.config.choices import choices
from codriving.gym.joint import JointDriving
from codriving.gym.registration import env_id, register_scenarios

REPOSITORY = Path(__file__).resolve().parents[2]


def run(code: str) -> str:
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code], cwd=REPOSITORY, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_every_scenario_is_registered() -> None:
    ids = {f"codriving/{name}{face}-v{n}" for name in choices("scenario") for face in ("", "-ego") for n in (0, 1)}
    assert ids <= set(gymnasium.registry)


def test_the_version_of_an_id_is_that_of_its_world() -> None:
    now = gymnasium.make("codriving/merge-v1").unwrapped
    with pytest.warns(DeprecationWarning, match="consider upgrading to version `v1`"):
        before = gymnasium.make("codriving/merge-v0", overrides=["cda.safety_check=false"]).unwrapped
    assert isinstance(now, JointDriving)
    assert isinstance(before, JointDriving)
    worlds = [made.parallel.environment for made in (before, now)]
    assert [world.limits is None for world in worlds] == [True, False]
    assert [hasattr(world.drivers, "styles") for world in worlds] == [False, True]
    assert [made.metadata["name"] for made in (before, now)] == ["codriving_merge_v0", "codriving_merge_v1"]


def test_the_prefix_registers() -> None:
    code = "import gymnasium; print(gymnasium.make('codriving.gym:codriving/merge-v1').spec.id)"
    assert run(code) == "codriving/merge-v1"


def test_importing_the_room_registers() -> None:
    code = "import gymnasium, codriving.gym; gymnasium.register_envs(codriving.gym); "
    assert run(code + "print(gymnasium.spec('codriving/intersection-v1').id)") == "codriving/intersection-v1"


def test_importing_us_alone_imports_nothing_heavy() -> None:
    heavy = "{'gymnasium', 'pettingzoo', 'numpy', 'highway_env', 'hydra', 'pandas'}"
    assert run(f"import sys, codriving; print(sorted({heavy} & set(sys.modules)))") == "[]"


def test_importing_us_leaves_the_import_system_alone() -> None:
    assert run("import sys; before = list(sys.meta_path); import codriving; print(sys.meta_path == before)") == "True"


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
        assert gymnasium.make(f"{name[:-3]}-ego-v1", cavs=3).reset(seed=0)[0].shape == (8, 6)
    finally:
        for made in [known for known in gymnasium.registry if "registered_by_test" in known]:
            del gymnasium.registry[made]
