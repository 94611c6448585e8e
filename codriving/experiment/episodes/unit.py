"""The unit of a batch: one seed of one cell, and what all units of a cell are labelled with."""

from dataclasses import dataclass
from typing import NamedTuple

from codriving.datatypes.parts import Method, Metric, Simulator


@dataclass(frozen=True, slots=True)
class Labels:
    """What the records of a cell are labelled with.

    Attributes:
        reasoner: Who reasons: ``rules`` or the name of a model.
    """

    scenario: str
    method: str
    variant: str
    reasoner: str
    memory: str = ""


@dataclass(frozen=True, slots=True)
class Unit:
    """One episode to drive."""

    cell: str
    seed: int


class Objects(NamedTuple):
    """What the episodes of one cell are driven with, built once a worker."""

    environment: Simulator
    method: Method
    metrics: Metric
