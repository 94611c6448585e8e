"""The page on a scenario of one's own: its commands run from any folder, and what it shows is the example."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
EXAMPLE = REPOSITORY / "examples" / "t_junction"
PAGE = (REPOSITORY / "docs" / "own-scenario.md").read_text(encoding="utf-8")
COMMANDS = re.findall(r"^    codriving (.*)$", PAGE, flags=re.MULTILINE)
PYTHON, *SHOWN = re.findall(r"^```python\n(.*?)^```", PAGE, flags=re.MULTILINE | re.DOTALL)

SHORT = "scenario.time_limit=1"
"""No vehicle arrives, but everything is gone through."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An empty folder with the example in it."""
    made = tmp_path_factory.mktemp("a reader")
    shutil.copytree(EXAMPLE, made / "examples" / "t_junction", ignore=shutil.ignore_patterns("__pycache__"))
    return made


def call(folder: Path, *arguments: str) -> str:
    """Run Python there; of ours nothing but the package is on its path."""
    clean = {name: value for name, value in os.environ.items() if name != "COLUMNS"}
    done = subprocess.run(
        [sys.executable, *arguments],
        cwd=folder,
        env={**clean, "PYTHONPATH": str(REPOSITORY), "PYTHONSAFEPATH": "1"},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_commands_run_as_they_stand_there(folder: Path) -> None:
    printed = []
    for command in COMMANDS:
        words = [word.replace("episodes=20", "episodes=1") for word in command.split()]
        short = [SHORT] if words[0] in ("run", "ablate") else []
        printed.append(call(folder, "-m", "codriving", *words, *short))
    listed, run, swept, ablated, film = printed
    assert re.search(r"^t_junction +A T-junction: .*\.$", listed, flags=re.MULTILINE)
    assert re.search(r"^codriving full +1 ", run, flags=re.MULTILINE)
    assert len(re.findall(r"^(?:intersection|t_junction) +codriving full +[46] ", swept, flags=re.MULTILINE)) == 4
    assert len(re.findall(r"^codriving ", ablated, flags=re.MULTILINE)) == 7 + 6
    assert film.startswith("Wrote outputs/run/t_junction/")
    assert len(list((folder / "outputs" / "run" / "t_junction").rglob("replay.gif"))) == 1


def test_python_runs_as_it_stands_there(folder: Path) -> None:
    code = PYTHON.replace('"episodes=2"', f'"episodes=2", "{SHORT}"')
    ask = "print(len(results.episodes), env.possible_agents)"
    assert call(folder, "-c", f"{code}\n{ask}").endswith("2 ['CAV1', 'CAV2', 'CAV3', 'CAV4']\n")


def test_code_that_is_shown_is_that_of_the_example() -> None:
    module = (EXAMPLE / "t_junction.py").read_text(encoding="utf-8")
    assert len(SHOWN) == 3
    for line in (line for block in SHOWN for line in block.splitlines() if line):
        assert line in module, line
    settings = (EXAMPLE / "conf" / "scenario" / "t_junction.yaml").read_text(encoding="utf-8")
    (block,) = re.findall(r"^```yaml\n(.*?)^```", PAGE, flags=re.MULTILINE | re.DOTALL)
    assert settings.startswith(block)
