"""What a worker does with one unit: build its objects once, drive, save."""

import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol

from codriving.datatypes.outcome import Ending
from codriving.errors import UserError
from codriving.experiment.episodes.episode import EpisodeResult, failed_result, run_episode
from codriving.experiment.episodes.unit import Labels, Objects, Unit


class After(Protocol):
    """What is done with an episode once it is saved, for instance a film; it never changes what was saved."""

    def kept(self, unit: Unit) -> Ending | None:
        """Tell how an episode ended that is saved already and need not be driven; None if there is none."""
        ...

    def finish(self, unit: Unit) -> None:
        """Do it; what goes wrong is noted where the result would be, and stops nobody."""
        ...

    def abandon(self, unit: Unit, error: Exception) -> None:
        """Note that it cannot be done."""
        ...


@dataclass(frozen=True)
class Job:
    """All that a process needs for any unit of a batch; it is pickled to the workers."""

    labels: Mapping[str, Labels]
    build: Callable[[str], Objects]
    save: Callable[[Unit, EpisodeResult], None]
    after: After | None = None


@dataclass(frozen=True, slots=True)
class Report:
    """What the parent is told of a unit.

    Attributes:
        message: What went wrong, for ``error``.
    """

    unit: Unit
    ending: Ending
    message: str = ""


KEPT = 4
"""Cells whose objects a worker keeps."""


class Worker:
    """Drives units one after another, with objects of its own."""

    def __init__(self, job: Job, go_on: Callable[[], None] = lambda: None) -> None:
        """Prepare; objects are built when the first unit of their cell comes.

        Args:
            go_on: Called before each decision; raises what is no ``Exception`` to give the episode up.
        """
        self._job, self._go_on = job, go_on
        self._objects: dict[str, Objects] = {}

    def run(self, unit: Unit) -> Report:
        """Drive one unit and save it.

        Raises:
            UserError: If the config cannot be built, the result cannot be saved, or the language model must not be used
                any more: the whole batch has to stop.
        """
        after = self._job.after
        kept = after.kept(unit) if after else None
        report = self._save(unit) if kept is None else Report(unit, kept)
        if after:
            after.finish(unit)
        return report

    def _save(self, unit: Unit) -> Report:
        result = self._drive(unit)
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

    def abandon(self, unit: Unit, error: Exception) -> Report:
        """Save a unit as failed without driving it.

        Raises:
            UserError: If the record cannot be saved.
        """
        after = self._job.after
        kept = after.kept(unit) if after else None
        if after and kept is not None:
            after.abandon(unit, error)
            return Report(unit, kept)
        result = failed_result(self._job.labels[unit.cell], unit.seed, error)
        self._job.save(unit, result)
        return Report(unit, Ending.ERROR, result.record.outcome.message)

    def _drive(self, unit: Unit) -> EpisodeResult:
        labels = self._job.labels[unit.cell]
        try:
            if unit.cell not in self._objects:
                # Units come cell by cell: what came first is not wanted again, and a sweep may have hundreds.
                while len(self._objects) >= KEPT:
                    del self._objects[next(iter(self._objects))]
                self._objects[unit.cell] = self._job.build(unit.cell)
        except UserError:
            raise
        except Exception as error:
            return failed_result(labels, unit.seed, error, traceback.format_exc())
        return run_episode(*self._objects[unit.cell], seed=unit.seed, labels=labels, go_on=self._go_on)
