"""Where results come from: versions, commit and machine, for the manifest."""

import hashlib
import os
import platform
import subprocess
from contextlib import suppress
from functools import cache, partial
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from codriving.version import __version__

# Packages that can change a result, besides this one.
PACKAGES = (
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
    "xllamacpp",
)


def versions() -> dict[str, str]:
    """Return the version of Python and of each package that can change a result, if it is installed."""
    # Ours is asked itself: what is installed in editable form keeps the version at which it was installed.
    found = {"python": platform.python_version(), "codriving": __version__}
    for name in PACKAGES:
        with suppress(PackageNotFoundError):
            found[name] = version(name)
    return found


@cache
def source_digest() -> str:
    """Return the SHA-256 of the files of this package, which one version need not tell."""
    top, digest = Path(__file__).resolve().parents[1], hashlib.sha256()
    for path in sorted(top.rglob("*")):
        name = path.relative_to(top)
        # Configs are a part of an installed package only, and nodes are sent theirs.
        if path.is_file() and name.parts[0] not in ("_conf", "_experiments") and not name.name.endswith((".pyc", "~")):
            content = hashlib.sha256(path.read_bytes()).digest()
            digest.update(hashlib.sha256(name.as_posix().encode()).digest() + content)
    return digest.hexdigest()


def machine() -> dict[str, str]:
    """Return operating system, processor and number of cores; no names of hosts or people."""
    return {
        "system": platform.system(),
        "release": platform.release(),
        "processor": platform.machine(),
        "cores": str(os.cpu_count() or 1),
    }


@cache
def commit() -> str | None:
    """Return the commit of the checkout that runs, with ``+changes`` if it was not clean.

    None for an installed package: a repository that merely surrounds it is not ours.
    """
    top = Path(__file__).resolve().parents[2]
    if not (top / ".git").exists():
        return None
    git = partial(subprocess.run, capture_output=True, text=True, timeout=10, check=True, cwd=top)
    try:
        head = git(["git", "rev-parse", "HEAD"]).stdout.strip()
        changes = git(["git", "status", "--porcelain", "--untracked-files=no"]).stdout.strip()
    except (OSError, subprocess.SubprocessError):
        return None
    return head + ("+changes" if changes else "")
