"""`shard=slurm` in a Slurm of one node, where Debian's slurm-wlm is installed: a task that is requeued goes on.

Its daemons give up tasks whose start takes long, as it may beside other tests: make test-slurm runs it by itself.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).resolve()
NEEDED = ("munged", "slurmctld", "slurmd", "sbatch", "unshare")
NAMESPACE = ("unshare", "--net", "--pid", "--fork", "--kill-child", "--mount-proc")
TOKENS = "episodes=8 seed=10000 scenario.cavs=2 scenario.hdvs=[1,1] scenario.time_limit=15 workers=1 run=big"
DIFFER = ("manifest.json", "timing.csv", "timing.json", ".lock")

# The second task is taken from its node in the middle of its work, once it has finished an episode.
SCRIPT = """\
#!/bin/bash
#SBATCH --array=1-2
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=B:TERM@60
set -e
if [ "$SLURM_ARRAY_TASK_ID" = 2 ] && [ -z "$SLURM_RESTART_COUNT" ]; then
    {{
        until compgen -G "outputs/run/big/parts/2-of-2/episodes/*/*/record.json" > /dev/null; do sleep 0.02; done
        scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_2"
    }} &
fi
exec {python} -m codriving run {tokens} shard=slurm
"""


def usable() -> bool:
    if "SLURM" not in os.environ or os.geteuid() or not all(map(shutil.which, NEEDED)):
        return False
    return subprocess.run([*NAMESPACE, "true"], capture_output=True, check=False).returncode == 0


pytestmark = pytest.mark.skipif(not usable(), reason="needs slurm-wlm, root and a network namespace: make test-slurm")


def run(*command: str, folder: Path) -> str:
    env = {**os.environ, "PYTHONPATH": str(HERE.parents[2])}
    done = subprocess.run(
        command, cwd=folder, env=env, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False
    )
    logs = [path.read_text()[-2000:] for path in (*folder.glob("slurm-*.out"), *folder.glob("cluster/*.log"))]
    assert done.returncode == 0, "\n".join([done.stdout, *logs])
    return done.stdout


def files(run: Path) -> dict[str, bytes]:
    found = {path.relative_to(run): path for path in run.rglob("*") if path.is_file() and path.name not in DIFFER}
    return {name.as_posix(): path.read_bytes() for name, path in found.items() if name.parts[0] != "parts"}


def test_a_task_that_is_requeued_goes_on_and_the_joined_run_is_that_of_one_process(tmp_path: Path) -> None:
    codriving = (sys.executable, "-m", "codriving")
    (tmp_path / "cluster").mkdir()
    (tmp_path / "big.sh").write_text(SCRIPT.format(python=sys.executable, tokens=TOKENS), encoding="utf-8")
    cluster = [sys.executable, str(HERE.with_name("one_node_slurm.py")), str(tmp_path / "cluster"), "big.sh"]
    assert "Submitted batch job 1" in run(*NAMESPACE, *cluster, folder=tmp_path)
    first, second = ((tmp_path / f"slurm-1_{task}.out").read_text() for task in (1, 2))
    assert "4 episodes of shard 1/2: 4 driven, 0 kept." in first
    assert "DUE TO JOB REQUEUE" in second
    went_on = re.search(r"4 episodes of shard 2/2: (\d) driven, (\d) kept\.", second)
    assert went_on is not None, second
    assert int(went_on[1]) + int(went_on[2]) == 4
    assert int(went_on[2]) > 0
    run(*codriving, "join", "big", folder=tmp_path)
    (tmp_path / "alone").mkdir()
    run(*codriving, "run", *TOKENS.split(), folder=tmp_path / "alone")
    joined, alone = (files(place / "outputs" / "run" / "big") for place in (tmp_path, tmp_path / "alone"))
    assert joined.keys() == alone.keys()
    assert [name for name in alone if joined[name] != alone[name]] == []
