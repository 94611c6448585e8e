"""The wheel holds everything: it runs from an empty environment and any folder, without the repository."""

import os
import shutil
import site
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[1]
SOURCES = ("codriving", "conf", "experiments", "pyproject.toml", "README.md", "LICENSE")


def call(*command: str | Path, folder: Path) -> str:
    clean = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "PYTHONHOME")}
    done = subprocess.run(
        [str(part) for part in command], cwd=folder, env=clean, capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A wheel, built from a copy so that nothing is left in the repository."""
    copy = tmp_path_factory.mktemp("source")
    for name in SOURCES:
        origin = REPOSITORY / name
        if origin.is_dir():
            shutil.copytree(origin, copy / name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy(origin, copy / name)
    call(sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", "dist", ".", folder=copy)
    (built,) = (copy / "dist").glob("*.whl")
    return built


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The scripts folder of an environment that holds the wheel, and borrows its dependencies from this one."""
    home = tmp_path_factory.mktemp("installed")
    venv.create(home, with_pip=False, symlinks=True)
    scripts = home / ("Scripts" if os.name == "nt" else "bin")
    packages = next(home.glob("lib/python3*/site-packages"), home / "Lib" / "site-packages")
    call(
        sys.executable, "-m", "pip", "--python", scripts / "python", "install",
        "--no-deps", "--no-index", "--disable-pip-version-check", wheel,
        folder=home,
    )  # fmt: skip
    # Plain paths only: a .pth of this environment, such as that of an editable install, is not followed.
    (packages / "borrowed.pth").write_text("\n".join(site.getsitepackages()) + "\n")
    return scripts


def test_wheel_holds_configs_and_experiments(wheel: Path) -> None:
    names = set(zipfile.ZipFile(wheel).namelist())
    assert "codriving/_conf/config.yaml" in names
    assert "codriving/_conf/scenario/intersection.yaml" in names
    assert "codriving/_experiments/experiments/paper_comparison.csv" in names
    assert "codriving/cli/app.py" in names
    assert "codriving/_conf/llm/openai.yaml" in names
    assert {f"codriving/llm/prompts/{name}/decide.user.md.j2" for name in ("informed", "planner")} <= names
    assert len([name for name in names if name.startswith("codriving/bound/envelopes/")]) == 4
    assert "codriving/_conf/train/madqn_junction.yaml" in names
    for name in ("default/madqn_junction", "paper/madqn_lanes", "default/tell_lanes", "paper/ppo_lanes"):
        assert {f"codriving/methods/learned/weights/{name}.{end}" for end in ("safetensors", "json", "csv")} <= names
    assert not [name for name in names if name.startswith(("tests", "conf/", "docs"))]


def test_installed_copy_is_the_one_that_runs(installed: Path, tmp_path: Path) -> None:
    where = call(installed / "python", "-c", "import codriving; print(codriving.__file__)", folder=tmp_path)
    assert Path(where.strip()).is_relative_to(installed.parent)


def test_installed_copy_lists_and_composes_from_any_folder(installed: Path, tmp_path: Path) -> None:
    assert "intersection" in call(installed / "codriving", "list", "scenarios", folder=tmp_path)
    assert "ablation" in call(installed / "codriving", "list", "experiments", folder=tmp_path)
    shown = call(installed / "codriving", "run", "--cfg", "experiments=ablation", "episodes=3", folder=tmp_path)
    assert "experiment: ablate" in shown
    assert "episodes: 3" in shown
    assert list(tmp_path.iterdir()) == []


def test_installed_copy_drives_an_episode(installed: Path, tmp_path: Path) -> None:
    printed = call(installed / "codriving", "run", "episodes=1", "workers=1", "run=first", folder=tmp_path)
    assert "intersection" in printed
    assert (tmp_path / "outputs" / "run" / "first" / "summary.csv").exists()


def test_installed_copy_drives_a_scenario_of_the_users_from_any_folder(installed: Path, tmp_path: Path) -> None:
    configs = REPOSITORY / "examples" / "t_junction" / "conf"
    command = ("run", "scenario=intersection,t_junction", "episodes=1", "scenario.time_limit=1", "run=own")
    printed = call(installed / "codriving", *command, "--config-dir", configs, folder=tmp_path)
    assert "t_junction" in printed
    assert len((tmp_path / "outputs" / "run" / "own" / "summary.csv").read_text().splitlines()) == 3
