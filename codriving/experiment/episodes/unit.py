"""The unit of a batch: one seed of one cell, and what all units of a cell are labelled with."""

from dataclasses import dataclass
from typing import NamedTuple

from codriving.experiment.episodes.protocols import Environment, Method, Metrics


@dataclass(frozen=True, slots=True)
class Labels:
    """What the records of a cell are labelled with.

    Attributes:
        scenario: Name of the scenario.
        method: Name of the method.
        variant: Name of the CDA variant.
        reasoner: Who reasons: ``rules`` or the name of a model.
        memory: What is recalled from; empty without a memory.
    """

    scenario: str
    method: str
    variant: str
    reasoner: str
    memory: str = ""


@dataclass(frozen=True, slots=True)
class Unit:
    """One episode to drive.

    Attributes:
        cell: Name of the cell.
        seed: Seed of the episode.
    """

    cell: str
    seed: int


class Objects(NamedTuple):
    """What the episodes of one cell are driven with, built once a worker.

    Attributes:
        environment: The world.
        method: Who decides.
        metrics: What is judged by.
    """

    environment: Environment
    method: Method
    metrics: Metrics
