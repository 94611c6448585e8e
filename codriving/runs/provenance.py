"""Where results come from: versions, commit and machine, for the manifest."""

import functools
import os
import platform
import subprocess
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

PACKAGES = (
    "codriving",
    "faiss-cpu",
    "gymnasium",
    "highway-env",
    "hydra-core",
    "litellm",
    "numpy",
    "omegaconf",
    "pandas",
    "pettingzoo",
    "scipy",
)
"""Packages that can change a result."""


def versions() -> dict[str, str]:
    """Give the version of Python and of each package that can change a result, if it is installed."""
    found = {"python": platform.python_version()}
    for name in PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found


def machine() -> dict[str, str]:
    """Give operating system, processor and number of cores; no names of hosts or people."""
    return {
        "system": platform.system(),
        "release": platform.release(),
        "processor": platform.machine(),
        "cores": str(os.cpu_count() or 1),
    }


@functools.cache
def commit() -> str | None:
    """Give the commit of the checkout that runs, with ``+changes`` if it was not clean.

    Returns:
        The commit, or None for an installed package: a repository that merely surrounds it is not ours.
    """
    top = Path(__file__).resolve().parents[2]
    if not (top / ".git").exists():
        return None
    head = _git(top, "rev-parse", "HEAD")
    if not head:
        return None
    return head + ("+changes" if _git(top, "status", "--porcelain", "--untracked-files=no") else "")


def _git(top: Path, *arguments: str) -> str:
    """Ask git; an empty answer if there is none."""
    try:
        answer = subprocess.run(
            ["git", "-C", str(top), *arguments], capture_output=True, text=True, timeout=10, check=True
        )
    except (OSError, subprocess.SubprocessError):
        return ""
    return answer.stdout.strip()
