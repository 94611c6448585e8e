"""What another machine is sent for an episode, and what it gives back; how that travels is a launcher's business."""

import platform
import threading
import uuid
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

from codriving.config import asks_for, build, looks_secret, targets
from codriving.datatypes import Model, Scenario
from codriving.errors import LauncherError, UserError
from codriving.experiment.contents import contents
from codriving.experiment.episode import EpisodeResult, Labels
from codriving.experiment.objects import BuildObjects, consults, make_method, memory_of, model_of
from codriving.experiment.worker import CELLS_AT_ONCE, Job, Objects, Report, Unit, Worker
from codriving.runs import flat, redact, source_digest, versions

# What only the process that writes the run needs to know.
_AT_HOME = ("output", "run", "experiment", "launcher", "shard", "workers", "render")
_ASKING = ("xllamacpp",)  # Packages by which models are asked, which no node does


class NodeTask(NamedTuple):
    """All that a node needs for one unit, as plain values; nothing of the environment, and no key."""

    unit: Unit
    labels: Labels
    build: Callable[[str], Objects]
    batch: str  # Tells this batch from others that the same node drives for
    program: Mapping[str, str]  # As ``program`` has it where the run is written
    files: Mapping[str, str]  # SHA-256 of each file that the config names


@dataclass(frozen=True, slots=True)
class Refusal:
    """What a node says that cannot drive."""

    node: str
    text: str


class NodeJob:
    """A job whose units are driven by nodes; only this process writes.

    Attributes:
        batch: What tells it from others.
    """

    def __init__(self, job: Job) -> None:
        self._job, self._here = job, Worker(job)
        self.batch, self._program = uuid.uuid4().hex, program()
        self._cells: dict[str, tuple[Callable[[str], Objects], Mapping[str, str]]] = {}

    def finish_here(self, unit: Unit) -> Report | None:
        """Do what is left of a unit that is driven already; None if it has to be driven."""
        return None if self._job.saved(unit) is None else self._here.run(unit)

    def task(self, unit: Unit) -> NodeTask:
        """Make what a node is sent.

        Raises:
            LauncherError: If it would be sent what may be a secret.
        """
        if unit.cell not in self._cells:
            self._cells[unit.cell] = _sent(self._job.build, unit.cell)
        build, files = self._cells[unit.cell]
        return NodeTask(unit, self._job.labels[unit.cell], build, self.batch, self._program, files)

    def take(self, unit: Unit, answer: EpisodeResult | Refusal) -> Report:
        """Save what a node has given back.

        Raises:
            LauncherError: If that is a refusal.
        """
        if isinstance(answer, Refusal):
            raise LauncherError(f"{answer.node} cannot drive {unit}: {answer.text}")
        return self._here.keep(unit, answer)

    def abandon(self, unit: Unit, error: Exception) -> Report:
        """Save a unit as failed."""
        return self._here.abandon(unit, error)


def drive_on_node(task: NodeTask) -> EpisodeResult | Refusal:
    """Drive a unit on a node, with objects that each of its threads builds once a cell."""
    try:
        worker, driven = _worker(task)
        worker.run(task.unit)
        return driven.pop()
    except UserError as error:
        return Refusal(f"the node {platform.node()}", str(error))


def program() -> dict[str, str]:
    """Return the versions that have to be the same on all nodes, and what the source of this program comes to."""
    found = {name: version for name, version in versions().items() if name not in _ASKING}
    return {**found, "source of codriving": source_digest()[:12]}


def program_differences(here: Mapping[str, str], there: Mapping[str, str]) -> str:
    """Name what differs on a node, with both versions; empty if nothing does."""
    names = [name for name in sorted(here.keys() | there.keys()) if here.get(name) != there.get(name)]
    return ", ".join(
        f"{name} is {there.get(name, 'missing')} there and {here.get(name, 'missing')} here" for name in names
    )


def _sent(build: Callable[[str], Objects], cell: str) -> tuple[Callable[[str], Objects], Mapping[str, str]]:
    """What builds the objects of one cell on a node, and the files that these need there."""
    if not isinstance(build, BuildObjects):
        return build, {}
    config = {key: value for key, value in build.configs[cell].items() if key not in _AT_HOME}
    if not asks_for(config["method"], Model, config["plugins"]):
        config["llm"] = None
    # Of a launcher of the user's own, for instance, a node needs no module.
    named = {target.partition(".")[0] for target in targets(config)}
    config["plugins"] = [name for name in config["plugins"] if name.partition(".")[0] in named]
    plain, masked = flat(config), flat(redact(config))
    suspect = [key for key, text in plain.items() if masked.get(key) != text or looks_secret(text)]
    if suspect or consults(config):
        what = f"{suspect[0]} may hold a secret" if suspect else "it asks a server"
        raise LauncherError(
            f"no node is sent {cell}: {what}, which stays on this machine; drive it with launcher=processes"
        )
    return BuildObjects({cell: config}), _files_named(config)


def _files_named(config: Mapping[str, Any]) -> dict[str, str]:
    """SHA-256 of each file on which the episodes of a config depend, by what it is."""
    scenario = build(config["scenario"], Scenario, "scenario", config["plugins"])
    method = make_method(config, model_of(config), memory_of(config))
    own = method.files(scenario.road, config.get("limits") is not None)
    return {file.name: file.sha256 for file in contents(config, own)}


_PLACE = threading.local()  # The workers of a thread, since objects must not be shared by two that drive
_BUILDING = threading.Lock()  # They import modules, and work out a road that all threads then share


def _worker(task: NodeTask) -> tuple[Worker, list[EpisodeResult]]:
    """Return what drives a cell in this thread, and where it leaves what it has driven."""
    workers: dict[tuple[str, str], tuple[Worker, list[EpisodeResult]]] = _PLACE.__dict__.setdefault("workers", {})
    key = task.batch, task.unit.cell
    if key not in workers:
        with _BUILDING:
            if differs := program_differences(task.program, program()):
                raise LauncherError(differs)
            if isinstance(task.build, BuildObjects):
                _refuse_changed(task.files, _files_named(task.build.configs[task.unit.cell]))
        while len(workers) >= CELLS_AT_ONCE:
            del workers[next(iter(workers))]
        driven: list[EpisodeResult] = []
        job = Job({task.unit.cell: task.labels}, _one_by_one(task.build), lambda _, result: driven.append(result))
        workers[key] = Worker(job), driven
    return workers[key]


def _refuse_changed(here: Mapping[str, str], there: Mapping[str, str]) -> None:
    names = [name for name in sorted(here.keys() | there.keys()) if here.get(name) != there.get(name)]
    if names:
        raise LauncherError(f"{', '.join(names)}: not the files that are here; copy them to the same path there")


def _one_by_one(build: Callable[[str], Objects]) -> Callable[[str], Objects]:
    def locked(cell: str) -> Objects:
        with _BUILDING:
            return build(cell)

    return locked
