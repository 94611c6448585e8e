"""A cell: one row of a table, which is one resolved config on many seeds."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from codriving.config import Point, build
from codriving.datatypes import Scenario
from codriving.errors import ConfigError
from codriving.experiment.contents import contents
from codriving.experiment.episode import Labels
from codriving.experiment.naming import folder_name, swept_values
from codriving.experiment.objects import make_method, memory_of, model_of
from codriving.experiment.scoring import scorers_of, settings_of_metric
from codriving.runs import CHOICES, CellEntry, NamedFile, fingerprint, settings_of


@dataclass(frozen=True)
class Cell:
    """One row of a table.

    Rows that differ in their metrics alone are driven once, and share a folder.
    """

    folder: str
    labels: Labels
    resolved: Mapping[str, Any]
    metrics: str = "standard"  # What the metric calls itself
    swept: Mapping[str, str] = field(default_factory=dict)
    choices: Mapping[str, str] = field(default_factory=dict)
    files: tuple[NamedFile, ...] = ()
    score: str = ""  # Name of its scores in a record; empty for that of the metric

    @property
    def score_name(self) -> str:
        """Name of its scores in a record."""
        return self.score or self.metrics

    @property
    def metric_settings(self) -> dict[str, str]:
        """Settings of its metric, by dotted key."""
        return settings_of_metric(self.resolved.get("metrics", {}))

    @property
    def driving_swept(self) -> dict[str, str]:
        """What was swept and changes what is driven."""
        return {key: value for key, value in self.swept.items() if key.partition(".")[0] != "metrics"}

    @cached_property
    def fingerprint(self) -> str:
        """What tells what is driven from all others; metrics take no part."""
        names = (self.labels.scenario, self.labels.method, self.labels.variant, self.labels.reasoner)
        return fingerprint(names, self.choices, self.resolved, self.files)

    def entry(self) -> CellEntry:
        """Describe it for the manifest."""
        return CellEntry(
            folder=self.folder,
            scenario=self.labels.scenario,
            method=self.labels.method,
            variant=self.labels.variant,
            reasoner=self.labels.reasoner,
            fingerprint=self.fingerprint,
            swept=self.driving_swept,
            settings=settings_of(self.resolved),
            choices={group: name for group, name in self.choices.items() if group in (*CHOICES, "cda")},
            files=self.files,
        )


def make_cell(
    resolved: Mapping[str, Any], point: Point | None = None, choices: Mapping[str, str] | None = None
) -> Cell:
    """Make the cell of a config; its labels are what its objects call themselves."""
    scenario = build(resolved["scenario"], Scenario, "scenario", resolved["plugins"])
    method = make_method(resolved, model_of(resolved), memory_of(resolved))
    (scorer,) = scorers_of(resolved).values()
    method.check_road(scenario.road, scenario.pace.target_speeds, 1 / scenario.pace.decision_frequency)
    for key, made in (("scenario", scenario), ("method", method), ("metrics", scorer.metric)):
        if not made.name:
            raise ConfigError(f"{key}: {type(made).__name__} needs an attribute 'name' of type str for the tables")
    labels = Labels(scenario.name, method.name, method.variant, method.reasoner, method.remembers)
    swept = swept_values(point.swept, resolved) if point else {}
    files = contents(resolved, method.files(scenario.road))
    return Cell(folder_name(labels), labels, resolved, scorer.metric.name, swept, choices or {}, files)


def with_metrics(config: Mapping[str, Any], rows: Sequence[Cell]) -> dict[str, Any]:
    """Put into a resolved config the metrics of all rows that it is driven for, by the name of their scores."""
    metrics = {row.score_name: row.resolved.get("metrics", {}) for row in rows}
    plugins = dict.fromkeys(module for row in rows for module in row.resolved.get("plugins", []))
    return {**config, "metrics": metrics, "plugins": list(plugins)}
