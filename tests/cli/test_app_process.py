"""What only a real process shows: start-up cost, what is imported, and one line on the screen."""

import os
import resource
import subprocess
import sys
from pathlib import Path

import pytest

from codriving.config.choices import choices

REPOSITORY = Path(__file__).resolve().parents[2]
HEAVY = (
    "faiss",
    "highway_env",
    "hydra",
    "litellm",
    "numpy",
    "omegaconf",
    "pandas",
    "pydantic",
    "rich",
    "scipy",
    "yaml",
)


def python(*args: str, folder: Path, **variables: str) -> subprocess.CompletedProcess[str]:
    path = os.pathsep.join(filter(None, [str(REPOSITORY), os.environ.get("PYTHONPATH")]))
    return subprocess.run(
        [sys.executable, *args],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": path, **variables},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


@pytest.mark.parametrize("args", [["--help"], ["run", "--help"], ["compare", "--help"], ["list", "--help"]])
def test_help_imports_nothing_heavy(tmp_path: Path, args: list[str]) -> None:
    script = (
        "import sys, codriving.cli.app as c\n"
        f"sys.argv = ['codriving', *{args!r}]\n"
        "try:\n    c.main()\n"
        "finally:\n"
        f"    print([name for name in {HEAVY!r} if name in sys.modules], file=sys.stderr)\n"
    )
    result = python("-c", script, folder=tmp_path)
    assert result.returncode == 0
    assert result.stderr.strip() == "[]"


def test_help_takes_less_than_0_3_s_of_cpu(tmp_path: Path) -> None:
    times = []
    for _ in range(3):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        assert python("-m", "codriving", "--help", folder=tmp_path).returncode == 0
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        times.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    assert min(times) < 0.3


def test_mistakes_are_one_line_without_traceback_from_any_folder(tmp_path: Path) -> None:
    result = python("-m", "codriving", "run", "scenario=nowhere", folder=tmp_path)
    assert (result.returncode, result.stdout) == (2, "")
    assert result.stderr == f"error: unknown scenario 'nowhere'; choices: {', '.join(choices('scenario'))}\n"
    assert list(tmp_path.iterdir()) == []


def test_bash_completes_a_choice_after_the_equals_sign(tmp_path: Path) -> None:
    words = "\n".join(["codriving", "run", "scenario", "=", "int"])
    result = python(
        "-c",
        "import sys; sys.argv = ['codriving']; from codriving.cli.app import main; main()",
        folder=tmp_path,
        _CODRIVING_COMPLETE="complete_bash",
        COMP_WORDS=words,
        COMP_CWORD="4",
    )
    assert result.stdout.split() == ["intersection"]
