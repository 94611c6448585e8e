"""One side of a comparison: a process that drives what it is asked for with the package of a checkout.

It runs with the code of any release since 0.1, so it imports no more than it needs of the checkout.
"""

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from time import process_time
from types import TracebackType
from typing import Any, Self

HERE = Path(__file__).resolve()
THIS = HERE.parents[1]


class Side:
    """A process that drives with the package of a checkout.

    Args:
        checkout: Folder with ``codriving`` in it.
        typed: Settings, as on the command line.
    """

    def __init__(self, checkout: Path, typed: Sequence[str]) -> None:
        command = [sys.executable, "-P", str(HERE), *typed]
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=checkout, env=surroundings(checkout), text=True
        )

    def drive(self, seed: int) -> dict[str, list[float]]:
        """Drive an episode.

        Returns:
            CPU time of each decision, that of the method's reset being part of the first, and of each step [s].
        """
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        print(seed, file=self._process.stdin, flush=True)
        answer: dict[str, list[float]] = json.loads(self._process.stdout.readline())
        return answer

    def memory(self) -> float:
        """Memory that the process holds at present [MB]."""
        pages = int(Path(f"/proc/{self._process.pid}/statm").read_text(encoding="ascii").split()[1])
        return pages * os.sysconf("SC_PAGE_SIZE") / 1e6

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        assert self._process.stdin is not None
        self._process.stdin.close()
        self._process.wait()


def surroundings(checkout: Path) -> dict[str, str]:
    """Environment variables of a process that takes the package of a checkout; each computes in one thread."""
    return {**os.environ, "PYTHONPATH": str(checkout), "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def answer(objects: Any, seed: int) -> dict[str, list[float]]:  # noqa: ANN401 - of another checkout
    """Drive an episode as a batch does, and give what each decision and each step took [s]."""
    environment, method = objects.environment, objects.method
    decisions, steps = [], []
    state = environment.reset(seed)
    before = process_time()
    method.reset(environment.road_map, environment.driving_model, seed)
    while environment.outcome is None:
        actions = method.act(state).actions
        between = process_time()
        state = environment.step(actions)
        after = process_time()
        decisions.append(between - before)
        steps.append(after - between)
        before = process_time()
    return {"decisions": decisions, "steps": steps}


def serve(typed: Sequence[str]) -> None:
    """Drive the seeds that come in, one a line."""
    from codriving.config.compose import compose
    from codriving.experiment.objects import BuildObjects

    objects = BuildObjects({"cell": compose(typed)})("cell")
    for line in sys.stdin:
        print(json.dumps(answer(objects, int(line))), flush=True)


if __name__ == "__main__":
    serve(sys.argv[1:])
