"""What a worker does with one unit: build the objects of its cell once, drive, save."""

import traceback
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from codriving.datatypes import CaseMemory, Ending, Method, Model, Simulator
from codriving.errors import UserError
from codriving.experiment.episode import EpisodeResult, Labels, failed_result, run_episode
from codriving.metrics import Scorer
from codriving.runs import episode_folder, removed, secrets_of, timing_of, write_episode

CELLS_AT_ONCE = 4  # Cells whose objects a worker holds


@dataclass(frozen=True, slots=True)
class Unit:
    """One episode to drive: one seed of one cell."""

    cell: str
    seed: int

    def __str__(self) -> str:
        return f"{self.cell}, seed {self.seed}"


class Objects(NamedTuple):
    """What the episodes of one cell are driven with, built once a worker."""

    environment: Simulator
    method: Method
    metrics: Mapping[str, Scorer]
    llm: Model | None = None
    memory: CaseMemory | None = None


@dataclass(frozen=True)
class SaveEpisode:
    """Writes episodes into a run folder."""

    run: Path
    variables: tuple[str, ...] = ()  # Environment variables whose values must not be written

    def __call__(self, unit: Unit, result: EpisodeResult) -> None:
        """Write one episode, whole or not at all; never make anew a folder that was taken away."""
        if not self.run.is_dir():
            raise removed(self.run)
        write_episode(
            episode_folder(self.run, unit.cell, unit.seed),
            result.record,
            result.trajectory,
            result.decisions,
            timing_of(result.seconds, result.decision_seconds, result.decision_cpu),
            result.traceback,
            result.transcript,
            secrets_of(self.variables),
        )


@dataclass(frozen=True, slots=True)
class Report:
    """What the parent is told of a unit."""

    unit: Unit
    ending: Ending
    message: str = ""  # What went wrong, for ``error``


class AfterEpisode(ABC):
    """What is done with an episode once it is saved, for instance a film; it never changes what was saved."""

    @abstractmethod
    def saved(self, unit: Unit) -> Ending | None:
        """Return how an episode ended that is saved already and need not be driven; None if there is none."""

    @abstractmethod
    def finish(self, unit: Unit) -> None:
        """Do it; what goes wrong is noted where the result would be, and stops no other episode."""

    @abstractmethod
    def abandon(self, unit: Unit, error: Exception) -> None:
        """Note that it cannot be done."""


@dataclass(frozen=True)
class Job:
    """All that a process needs for any unit of a batch; it is pickled to the workers."""

    labels: Mapping[str, Labels]
    build: Callable[[str], Objects]
    save: Callable[[Unit, EpisodeResult], None]
    after: AfterEpisode | None = None

    def saved(self, unit: Unit) -> Ending | None:
        """Return how an episode ended of which only what comes after is missing."""
        return self.after.saved(unit) if self.after else None


class Worker:
    """Drives units one after another, with objects of its own."""

    def __init__(self, job: Job, go_on: Callable[[], None] = lambda: None) -> None:
        self._job, self._go_on = job, go_on
        self._objects: dict[str, Objects] = {}

    def run(self, unit: Unit) -> Report:
        """Drive one unit and save it."""
        if (ending := self._job.saved(unit)) is not None:
            return self._finished(Report(unit, ending))
        labels = self._job.labels[unit.cell]
        try:
            environment, method, metrics, _, memory = self._objects_of(unit.cell)
            result = run_episode(environment, method, metrics, unit.seed, labels, self._go_on, memory)
        except UserError:
            raise
        except Exception as error:
            result = failed_result(labels, unit.seed, error, traceback.format_exc())
        return self.keep(unit, result)

    def keep(self, unit: Unit, result: EpisodeResult) -> Report:
        """Save what was driven, wherever that was."""
        return self._finished(self._save(unit, result))

    def abandon(self, unit: Unit, error: Exception) -> Report:
        """Save a unit as failed without driving it."""
        ending = self._job.saved(unit)
        if self._job.after and ending is not None:
            self._job.after.abandon(unit, error)
            return Report(unit, ending)
        return self._save(unit, failed_result(self._job.labels[unit.cell], unit.seed, error))

    def _finished(self, report: Report) -> Report:
        if self._job.after:
            self._job.after.finish(report.unit)
        return report

    def _objects_of(self, cell: str) -> Objects:
        if cell not in self._objects:
            # Units come cell by cell: what came first is not wanted again, and a sweep may have hundreds.
            while len(self._objects) >= CELLS_AT_ONCE:
                del self._objects[next(iter(self._objects))]
            self._objects[cell] = self._job.build(cell)
        return self._objects[cell]

    def _save(self, unit: Unit, result: EpisodeResult) -> Report:
        try:
            self._job.save(unit, result)
        except UserError:
            raise
        except Exception as error:
            # A result that cannot be written (a NaN in the score, say) is a fault of the episode, not of the batch.
            result = failed_result(self._job.labels[unit.cell], unit.seed, error, traceback.format_exc())
            self._job.save(unit, result)
        outcome = result.record.outcome
        return Report(unit, outcome.ending, outcome.message)
