"""A clone has ``outputs/`` with a page of one screen, and nothing else of it is in git."""

import shutil
import subprocess

import pytest
from source import REPOSITORY


@pytest.mark.skipif(shutil.which("git") is None or not (REPOSITORY / ".git").exists(), reason="not in a clone")
def test_git_ignores_all_of_outputs_but_its_page() -> None:
    def ignored(name: str) -> bool:
        words = ["git", "-C", str(REPOSITORY), "check-ignore", "--quiet", "--no-index", name]
        return subprocess.run(words, check=False).returncode == 0

    assert [ignored(f"outputs/{name}") for name in ("run/x/summary.csv", "README.txt", "README.md")] == [
        True,
        True,
        False,
    ]


def test_the_page_fits_a_screen_and_names_what_the_makefile_makes() -> None:
    text = (REPOSITORY / "outputs" / "README.md").read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 30
    assert "`make paper`" in text
