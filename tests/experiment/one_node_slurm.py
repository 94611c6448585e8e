"""A Slurm of one node in a network namespace of its own with loopback only; run by ``unshare`` as root.

Starts munged, slurmctld and slurmd by hand, submits a script and waits until the queue is empty.
"""

import fcntl
import os
import socket
import struct
import subprocess
import sys
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from time import monotonic, sleep

UP, ADDRESS, FLAGS = 0x8914, 0x8916, 0x1 | 0x40
"""Requests of ioctl that set the flags and the address of an interface, and the flags of one that is up."""

PATIENCE = 120.0
"""How long to wait for anything [s]."""

CONF = """
ClusterName=one
SlurmctldHost=localhost
AuthType=auth/munge
AuthInfo=socket={folder}/munge,cred_expire=5
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SwitchType=switch/none
MpiDefault=none
SlurmdParameters=config_overrides
KillWait=2
NodeName=localhost NodeAddr=127.0.0.1 CPUs=2
PartitionName=main Nodes=localhost Default=YES
"""


def loopback() -> None:
    """Bring the loopback up, with a second address: of a host with 127.0.0.1 alone names are not looked up."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
        fcntl.ioctl(any_socket, UP, struct.pack("16sh14x", b"lo", FLAGS))
        second = struct.pack("16sH2x4s8x", b"lo:1", socket.AF_INET, socket.inet_aton("127.0.0.2"))
        fcntl.ioctl(any_socket, ADDRESS, second)


def said(*command: str) -> str:
    """Return what a command of Slurm says; nothing if it fails."""
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.stdout if done.returncode == 0 else ""


def wait_for(what: str, there: Callable[[], bool]) -> None:
    """Look again and again."""
    end = monotonic() + PATIENCE
    while not there():
        if monotonic() > end:
            raise TimeoutError(f"waited {PATIENCE:g} s for {what}")
        sleep(0.05)


def main(folder: Path, script: str) -> None:
    """Start the daemons, run the script to its end, and end them."""
    loopback()
    for name in ("state", "spool"):
        (folder / name).mkdir()
    key = folder / "key"
    key.write_bytes(os.urandom(1024))
    key.chmod(0o400)
    conf = folder / "slurm.conf"
    conf.write_text(CONF.format(folder=folder), encoding="utf-8")
    os.environ["SLURM_CONF"] = str(conf)
    files = [f"--{name}={folder / place}" for name, place in MUNGE_FILES.items()]
    daemons = (
        ["munged", "--foreground", "--force", *files],
        ["slurmctld", "-D", "-i"],
        ["slurmd", "-D", "-N", "localhost"],
    )
    with ExitStack() as started:
        for command in daemons:
            log = started.enter_context((folder / f"{command[0]}.log").open("w"))
            daemon = started.enter_context(subprocess.Popen(command, stdout=log, stderr=log))
            started.callback(daemon.terminate)
            if command[0] == "munged":
                wait_for("munged", (folder / "munge").exists)
        wait_for("the node", lambda: "idle" in said("sinfo", "--noheader", "--format=%T"))
        print(subprocess.run(["sbatch", script], check=True, capture_output=True, text=True).stdout, end="")

        def empty() -> bool:
            # What is requeued would wait two minutes for its turn.
            for job in said("squeue", "--noheader", "--format=%i %r").splitlines():
                if job.endswith("BeginTime"):
                    said("scontrol", "update", f"JobId={job.split()[0]}", "StartTime=now")
            done = subprocess.run(["squeue", "--noheader"], capture_output=True, text=True, check=True)
            return not done.stdout.strip()

        wait_for("the jobs", empty)


MUNGE_FILES = {
    "key-file": "key",
    "socket": "munge",
    "pid-file": "munged.pid",
    "log-file": "munged-own.log",
    "seed-file": "seed",
}

if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
