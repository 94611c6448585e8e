"""A cell: one row of a table, which is one resolved config on many seeds."""

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from codriving.config.build import build
from codriving.config.show import WITHOUT_EFFECT, fingerprint
from codriving.episodes.unit import Labels
from codriving.errors import ConfigError
from codriving.storage.manifest import CellEntry
from codriving.storage.redaction import flat, redact


@dataclass(frozen=True)
class Cell:
    """One row of a table.

    Attributes:
        folder: Name of its folder, readable and unique in the run.
        labels: What its records are labelled with.
        resolved: Its resolved config of plain values.
        metrics: Name of the definitions that it is scored by.
    """

    folder: str
    labels: Labels
    resolved: Mapping[str, Any]
    metrics: str = "standard"

    def entry(self) -> CellEntry:
        """Describe it for the manifest."""
        relevant = {name: value for name, value in self.resolved.items() if name not in WITHOUT_EFFECT}
        return CellEntry(
            folder=self.folder,
            scenario=self.labels.scenario,
            method=self.labels.method,
            variant=self.labels.variant,
            reasoner=self.labels.reasoner,
            fingerprint=fingerprint(self.resolved),
            settings=flat(redact(relevant)),
        )


def make_cell(resolved: Mapping[str, Any]) -> Cell:
    """Make the cell of a config; its labels are what its objects call themselves.

    Args:
        resolved: A validated config of plain values.

    Returns:
        The cell.

    Raises:
        ConfigError: If an object cannot be built or has no name.
    """
    plugins = resolved["plugins"]
    scenario = build(resolved["scenario"], plugins, "scenario")
    method = build(resolved["method"], plugins, "method")
    labels = Labels(
        scenario=_label(scenario, "name", "scenario"),
        method=_label(method, "name", "method"),
        variant=_label(method, "variant", "method"),
        reasoner=_label(method, "reasoner", "method"),
    )
    metrics = _label(build(resolved["metrics"], plugins, "metrics"), "name", "metrics")
    return Cell(folder_name(labels), labels, resolved, metrics)


def _label(made: object, attribute: str, key: str) -> str:
    value = getattr(made, attribute, None)
    if not isinstance(value, str):
        raise ConfigError(
            f"{key}: {type(made).__name__} needs an attribute {attribute!r} of type str for the tables, got {value!r}"
        )
    return value


def folder_name(labels: Labels) -> str:
    """Name the folder of a cell so that a person finds it and every file system takes it.

    Args:
        labels: What the records are labelled with.

    Returns:
        ``<scenario>-<method>-<variant>`` with everything unusual replaced.
    """
    words = (labels.scenario, labels.method, labels.variant)
    return "-".join(re.sub(r"[^A-Za-z0-9._]+", "_", word).lstrip(".") for word in words if word)


def distinct(cells: Sequence[Cell]) -> tuple[Cell, ...]:
    """Drop cells that are the same config again, and tell apart those that are only called the same.

    Args:
        cells: Cells in the order of the table.

    Returns:
        The cells with unique folders, in the same order.
    """
    once: dict[str, Cell] = {}
    for cell in cells:
        once.setdefault(fingerprint(cell.resolved), cell)
    names = Counter(cell.folder for cell in once.values())
    return tuple(
        cell if names[cell.folder] == 1 else replace(cell, folder=f"{cell.folder}-{print_[:8]}")
        for print_, cell in once.items()
    )
