"""A cell: one row of a table, which is one resolved config on many seeds."""

import json
import re
from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

from codriving.config import LISTED, STRESS, Point, build
from codriving.datatypes import Scenario
from codriving.errors import ConfigError
from codriving.experiment.contents import contents
from codriving.experiment.episode import Labels
from codriving.experiment.flows import check_flow
from codriving.experiment.objects import communication_of, make_method, memory_of, model_of, thinking_of
from codriving.experiment.scoring import names_of_scores, scorers_of, settings_of_metric
from codriving.reports import FILTERED
from codriving.runs import CHOICES, CellEntry, NamedFile, fingerprint, redact, settings_of

LONGEST = 100  # Characters of a folder's name; Windows allows 260 for a whole path

KNOWS = "which no vehicle can know."  # What ends the remark on a method that is told more than others

_LABELS = {"scenario": "scenario", "method": "method"}
# The label in which a group, or a key of it, may show.
_LABELS_BELOW = {
    "cda": "variant",
    "order": "variant",
    "filter": "variant",
    "judgement": "variant",
    "method": "variant",
    "llm": "reasoner",
}


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
    remark: str = ""  # What a reader of its numbers has to know of the method
    repeatable: bool | None = None  # False where the times of a language model are measured, not replayed
    notes: tuple[str, ...] = ()  # What is said of several methods in one line, whose names ``{}`` stands for
    # What was swept as it was typed, of this point and of those that are the same config.
    points: tuple[Mapping[str, str], ...] = ()

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
            repeatable=self.repeatable,
        )


def make_cell(
    resolved: Mapping[str, Any], point: Point | None = None, choices: Mapping[str, str] | None = None
) -> Cell:
    """Make the cell of a config; its labels are what its objects call themselves."""
    scenario = build(resolved["scenario"], Scenario, "scenario", resolved["plugins"])
    memory = memory_of(resolved)
    llm = model_of(resolved)
    method = make_method(resolved, llm, memory)
    (scorer,) = scorers_of(resolved).values()
    check_flow(resolved, method, scorer.metric, memory)
    method.check_road(scenario.road, scenario.pace.target_speeds, 1 / scenario.pace.decision_frequency)
    for key, made in (("scenario", scenario), ("method", method), ("metrics", scorer.metric)):
        if not isinstance(made.name, str) or not made.name:
            raise ConfigError(f"{key}: {type(made).__name__} needs an attribute 'name' of type str for the tables")
    for name in ("variant", "reasoner"):
        if not isinstance(getattr(method, name), str):
            raise ConfigError(f"method: the attribute {name!r} of {type(method).__name__} must be of type str")
    labels = Labels(scenario.name, method.name, method.variant, method.reasoner, method.remembers)
    swept = swept_values(point.swept, resolved) if point else {}
    files, chosen = contents(resolved, method.files(scenario.road, resolved.get("limits") is not None)), choices or {}
    remark = method.remark(scenario.road, {group: chosen[group] for group in ("limits", "drivers") if group in chosen})
    if method.knows_drivers and not remark.endswith(KNOWS):
        # Whatever a method says of itself.
        remark = f"{remark} {method.name}: it is told how human drivers treat the right of way, {KNOWS}".strip()
    # What a table has a column of need not be said below it.
    brief = point is not None and any(key == STRESS or key.partition(".")[0] == "v2x" for key in point.swept)
    notes = thinking_of(resolved).notes(method) + communication_of(resolved).notes(method, brief)
    told = labels, resolved, scorer.metric.name, swept, chosen, files
    points = (point.swept,) if point else ()
    repeatable = False if llm and llm.waits and llm.latency == "measured" and llm.cache != "replay" else None
    return Cell(folder_name(labels), *told, remark=remark, repeatable=repeatable, notes=notes, points=points)


def with_metrics(config: Mapping[str, Any], rows: Sequence[Cell]) -> dict[str, Any]:
    """Put into a resolved config the metrics of all rows that it is driven for, by the name of their scores."""
    metrics = {row.score_name: row.resolved.get("metrics", {}) for row in rows}
    plugins = dict.fromkeys(module for row in rows for module in row.resolved.get("plugins", []))
    return {**config, "metrics": metrics, "plugins": list(plugins)}


def folder_name(labels: Labels, swept: Mapping[str, str] | None = None, reasoner: bool = False) -> str:
    """Name the folder of a cell."""
    words = [labels.scenario, labels.method, labels.variant, *([labels.reasoner] if reasoner else [])]
    plain = [re.sub(r"[^A-Za-z0-9._]+", "_", word).lstrip(".") for word in words if word]
    values = {key: re.sub(r"[^A-Za-z0-9._+-]+", "_", text).strip("_") for key, text in (swept or {}).items()}
    return "-".join([*plain, *(f"{key}={value or '_'}" for key, value in values.items())]).rstrip(".")


def distinct(cells: Sequence[Cell]) -> tuple[Cell, ...]:
    """Drop cells that are the same config again, and tell the others apart; those that drive alike share a folder."""
    once: dict[tuple[str, str], Cell] = {}
    for cell in cells:
        mark = _same(cell)
        known = once.get(mark)
        once[mark] = replace(known, points=(*known.points, *cell.points)) if known else cell
    shown = shown_apart([(cell.labels, cell.swept) for cell in once.values()])
    told = [replace(cell, swept=swept) for cell, swept in zip(once.values(), shown, strict=True)]
    alike: dict[str, list[int]] = {}
    for index, cell in enumerate(told):
        alike.setdefault(cell.fingerprint, []).append(index)
    for group, folder in zip(alike.values(), _folders([told[group[0]] for group in alike.values()]), strict=True):
        names = names_of_scores([(told[index].metrics, told[index].metric_settings) for index in group])
        for index, name in zip(group, names, strict=True):
            told[index] = replace(told[index], folder=folder, score=name)
    return tuple(told)


def _same(cell: Cell) -> tuple[str, str]:
    """What tells a row from all others: what is driven, and how it is scored."""
    return cell.fingerprint, json.dumps([cell.metrics, cell.metric_settings])


def _folders(cells: Sequence[Cell]) -> list[str]:
    """Name each, with no more in the name than it takes to tell it from the others."""
    marks = [cell.fingerprint[:8] for cell in cells]
    plain, longer = ([folder_name(c.labels, c.driving_swept, reasoner) for c in cells] for reasoner in (False, True))
    short = [
        name if len(name) <= LONGEST else f"{name[: LONGEST - len(mark) - 1]}-{mark}"
        for name, mark in zip(_apart(plain, longer), marks, strict=True)
    ]
    return _apart(short, [f"{name}-{mark}" for name, mark in zip(short, marks, strict=True)])


def _apart(names: Sequence[str], longer: Sequence[str]) -> list[str]:
    """Give those a longer name that would be one folder, also where case makes no difference."""
    taken = Counter(name.casefold() for name in names)
    return [long if taken[name.casefold()] > 1 else name for name, long in zip(names, longer, strict=True)]


def repeated(cells: Sequence[Cell]) -> tuple[str, ...]:
    """Say which values of a sweep come to the same config as others, whose rows would be looked for in vain."""
    first: dict[tuple[str, str], Cell] = {}
    notes: dict[str, None] = {}
    for cell in cells:
        known = first.setdefault(_same(cell), cell)
        differing = [key for key in cell.swept if cell.swept[key] != known.swept.get(key)]
        ours, theirs = (" ".join(f"{key}={one.swept[key]}" for key in differing) for one in (cell, known))
        if ours:
            # What two axes of stress have in common they have for every method.
            name = "" if differing == [STRESS] else f"{cell.labels.method} {cell.labels.variant}".strip() + ": "
            notes[f"{name}{ours} is the same configuration as {theirs} and has no row of its own."] = None
    return tuple(notes)


def without_effect(cells: Sequence[Cell]) -> tuple[str, ...]:
    """Say of an order, filter or judge that was chosen which methods do not notice it, and what else several share."""
    notes: dict[str, dict[str, None]] = {}
    for cell in cells:
        method, order = cell.resolved["method"], cell.resolved.get("order")
        said = list(cell.notes)
        if order is not None and method.get("order") != order:
            said.append("order={order} has no effect on {}: what orders by itself, or not at all, does not read it.")
        if cell.resolved.get("filter") is not None and not cell.labels.variant.endswith(FILTERED):
            said.append("filter={filter} has no effect on {}: what has this check or gives no actions is not filtered.")
        if cell.resolved.get("judgement") is not None and "judgement=" not in cell.labels.variant:
            said.append(
                "judgement={judgement} has no effect on {}: it asks no judge of human drivers, or has no model "
                "or memory to ask."
            )
        for text in said:
            notes.setdefault(text.format("{}", **cell.choices), {})[cell.labels.method] = None
    return tuple(text.format(", ".join(names)) for text, names in notes.items())


def swept_values(swept: Mapping[str, str], resolved: Mapping[str, Any]) -> dict[str, str]:
    """Read off a config what stands in it for the keys that were given several values."""
    plain = redact(resolved)
    return {key: typed if key in LISTED else _config_value(plain, key, typed) for key, typed in swept.items()}


def _config_value(node: object, key: str, typed: str) -> str:
    for part in key.split("."):
        if isinstance(node, Mapping) and part in node:
            node = node[part]
        elif isinstance(node, list) and part.isdecimal() and int(part) < len(node):
            node = node[int(part)]
        else:
            return typed
    return node if isinstance(node, str) else json.dumps(node, ensure_ascii=False)


def shown_apart(cells: Sequence[tuple[Labels, Mapping[str, str]]]) -> list[dict[str, str]]:
    """Keep of the swept keys those that need a column of their own."""
    kept = [key for key in dict.fromkeys(key for _, swept in cells for key in swept) if _needs_column(key, cells)]
    # A choice of scenario may have the name of another one: two files for one class.
    heads = {key: f"{key}_choice" if key in _LABELS else key for key in kept}
    return [{head: swept[key] for key, head in heads.items() if key in swept} for _, swept in cells]


def _needs_column(key: str, cells: Sequence[tuple[Labels, Mapping[str, str]]]) -> bool:
    if len({swept.get(key) for _, swept in cells}) == 1:
        return False
    label = _LABELS.get(key) or _LABELS_BELOW.get(key.partition(".")[0])
    if label is None:
        return True
    values = defaultdict(set)
    for labels, swept in cells:
        values[getattr(labels, label)].add(swept.get(key))
    return any(len(several) > 1 for several in values.values())
