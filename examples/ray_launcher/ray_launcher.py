"""A launcher of one's own: episodes as tasks of Ray; what a node is sent and what is saved comes from CoDriving."""

from collections import deque
from collections.abc import Generator, Sequence
from typing import Any

from codriving.errors import ConfigError, LauncherError
from codriving.experiment.launchers import Launcher, worker_count
from codriving.experiment.nodes import NodeJob, drive_on_node
from codriving.experiment.worker import Job, Report, Unit


class Ray(Launcher):
    """Stateless tasks, of which Ray repeats those of a process or node that dies.

    Args:
        address: Of a cluster; None starts one on this machine.
    """

    elsewhere = True  # So episodes that ask a model stay in the process that writes the run

    def __init__(self, address: str | None) -> None:
        self.address = address

    def prepare(self, workers: int | str, units: int, preload: Sequence[str]) -> None:
        """Refuse before anything is written what cannot drive."""
        _ray()

    def launch(
        self, units: Sequence[Unit], job: Job, workers: int | str, preload: Sequence[str]
    ) -> Generator[Report, None, None]:
        """Keep as many units under way as there are CPUs, and save each as it comes back."""
        ray, nodes = _ray(), NodeJob(job)
        waiting, flying = deque(units), dict[Any, Unit]()
        here = {} if self.address else {"num_cpus": worker_count(workers, len(units)), "include_dashboard": False}
        ray.init(address=self.address, log_to_driver=False, configure_logging=False, **here)
        try:
            drive = ray.remote(num_cpus=1, max_retries=1)(drive_on_node)
            while waiting or flying:
                while waiting and len(flying) < int(ray.cluster_resources().get("CPU", 0)):
                    unit = waiting.popleft()
                    if (report := nodes.finish_here(unit)) is not None:
                        yield report
                    else:
                        flying[drive.remote(nodes.task(unit))] = unit
                for done in ray.wait(list(flying), num_returns=1, timeout=1.0)[0] if flying else ():
                    unit = flying.pop(done)
                    try:
                        answer = ray.get(done)
                    except ray.exceptions.WorkerCrashedError as death:
                        yield nodes.abandon(unit, death)
                    except ray.exceptions.RayError as error:
                        raise LauncherError(f"Ray failed to drive {unit}: {str(error).splitlines()[0]}") from error
                    else:
                        yield nodes.take(unit, answer)
        finally:
            ray.shutdown()


def _ray() -> Any:  # noqa: ANN401 - a module that need not be there
    try:
        import ray
    except ImportError as error:
        raise ConfigError(f"launcher=ray needs Ray ({error}); pip install ray") from error
    return ray
