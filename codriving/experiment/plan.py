"""What is to be run, worked out and checked before anything is driven; a refusal names the cell it is about."""

import csv
import json
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from codriving.config import ROOT, SUITE, Point, build, changed_worlds, compose_named, validate
from codriving.errors import ConfigError
from codriving.experiment.cells import Cell, distinct, make_cell, repeated, without_effect
from codriving.experiment.flows import is_flow, refuse_mixed
from codriving.experiment.launchers import Launcher
from codriving.experiment.objects import modules_to_preload
from codriving.experiment.remembering import pinned
from codriving.experiment.shards import check_shard, shard_of
from codriving.runs import MASK, Part, Shard, redact

T = TypeVar("T")

# What all cells of a run have in common; classes may belong to one scenario alone, templates to one cell.
SHARED = (*(name for name in ROOT if name not in ("plugins", "prompts")), "launcher")


@dataclass(frozen=True)
class Plan:
    """A run that can be started."""

    cells: tuple[Cell, ...]
    first_seed: int
    episodes: int
    launcher: Launcher
    workers: int | str  # Number of processes, or ``auto``
    output: Path
    experiment: str
    run: str | None  # Name of the run, or None for its time
    notes: tuple[str, ...] = ()
    render: bool = False
    config_dir: Path | None = None  # Folder with YAMLs of the user
    shard: Shard | None = None  # The share of it that is driven; None for all
    part: Part | None = None  # What the part of a shard keeps of the command
    waits: bool = False  # Whether to wait for another process that drives it

    @property
    def folder(self) -> Path | None:
        """The folder in which it is driven; None if that is called after the time."""
        if self.run is None:
            return None
        run = self.output / self.experiment / self.run
        return run / self.shard.folder if self.shard else run

    @property
    def seeds(self) -> range:
        """The seeds of every cell."""
        return range(self.first_seed, self.first_seed + self.episodes)

    @property
    def units(self) -> Iterator[tuple[int, int]]:
        """What is driven: the place of its cell among those that are driven, and its seed."""
        for cell in range(len(self.driven)):
            for place, seed in enumerate(self.seeds):
                if self.shard is None or self.shard.has(cell, place):
                    yield cell, seed

    @property
    def driven(self) -> tuple[Cell, ...]:
        """The cells whose episodes are driven; those that differ in their metrics alone stand here once."""
        return tuple({cell.folder: cell for cell in reversed(self.cells)}.values())[::-1]

    @property
    def configs(self) -> Mapping[str, Mapping[str, Any]]:
        """Resolved config of each cell, by the name of its folder."""
        return {cell.folder: cell.resolved for cell in self.cells}


def make_plan(points: Sequence[Point], config_dir: Path | None = None, drives: bool = True) -> Plan:
    """Plan a run with one cell a point.

    Args:
        drives: Whether anything is going to be driven.
    """
    configs, choices = composed(points, config_dir)
    first = configs[0]
    launcher = build(first["launcher"], Launcher, "launcher", first["plugins"])
    shard = shard_of(first["shard"], os.environ)
    if drives and not _is_complete(first, len(configs)):
        # Imports take a second: let them pass while the configs are checked here.
        launcher.prepare(first["workers"], first["episodes"] * len(configs), modules_to_preload(configs))
    validated(points, configs)
    refuse_mixed(configs)
    check_shard(shard, first["run"], configs)
    configs = each_cell(points, configs, pinned)
    cells = each_cell(points, list(zip(configs, points, choices, strict=True)), lambda part: make_cell(*part))
    return Plan(
        cells=distinct(cells),
        first_seed=first["seed"],
        episodes=first["episodes"],
        launcher=launcher,
        workers=first["workers"],
        output=Path(first["output"]),
        experiment=first["experiment"],
        run=first["run"],
        notes=(
            *repeated(cells),
            *without_effect(cells),
            *changed_worlds([suite_of(point) for point in points], configs, config_dir),
        ),
        render=first["render"],
        config_dir=config_dir,
        shard=shard,
    )


def refuse_flows(why: str, plan: Plan) -> None:
    """Refuse flows in the plan of a command that has no use for them."""
    if any(is_flow(cell.resolved) for cell in plan.cells):
        raise ConfigError(why)


def _is_complete(config: Mapping[str, Any], cells: int) -> bool:
    """Whether the run is most likely complete, so that nothing need be prepared for it."""
    if config["run"] is None:
        return False
    table = Path(config["output"], config["experiment"], config["run"], "episodes.csv")
    try:
        with table.open(encoding="utf-8", newline="") as file:
            rows = sum(1 for _ in csv.reader(file)) - 1
    except (OSError, ValueError, csv.Error):
        return False
    return rows >= int(config["episodes"]) * cells


def suite_of(point: Point) -> str | None:
    """Return the suite that the overrides of a config name."""
    named = [token.partition("=")[2] for token in point.overrides if token.lstrip("+").partition("=")[0] == SUITE]
    return named[-1] if named else None


def composed(
    points: Sequence[Point], config_dir: Path | None = None
) -> tuple[list[dict[str, Any]], list[dict[str, str]]]:
    """Compose the config of every cell; one after another, since Hydra's state is global."""
    pairs = each_cell(points, points, lambda point: _composed(point, config_dir))
    configs = [config for config, _ in pairs]
    for point, config in zip(points, configs, strict=True):
        for key in SHARED:
            if config[key] != configs[0][key]:
                one, other = _plain(configs[0][key]), _plain(config[key])
                raise ConfigError(
                    f"{key} is {one} in the cell {cell_name(points[0])} and {other} in the cell {cell_name(point)}; "
                    f"it belongs to the run as a whole, so set {key} on the command line"
                )
    return configs, [choices for _, choices in pairs]


def _composed(point: Point, config_dir: Path | None) -> tuple[dict[str, Any], dict[str, str]]:
    config, choices = compose_named(point.overrides, config_dir)
    return point.given.put_into(config, choices) if point.given else (config, choices)


def validated(points: Sequence[Point], configs: Sequence[Mapping[str, Any]]) -> None:
    """Check every node of every cell by building it."""
    each_cell(points, configs, validate)


def each_cell(points: Sequence[Point], given: Sequence[Any], work: Callable[[Any], T]) -> list[T]:
    """Do the same for every cell."""
    done: list[T] = []
    refusals: dict[int, ConfigError] = {}
    for index, item in enumerate(given):
        try:
            done.append(work(item))
        except ConfigError as err:
            refusals[index] = err
        if refusals and (done or len(set(map(str, refusals.values()))) > 1):
            break
    if not refusals:
        return done
    index, first = next(iter(refusals.items()))
    if len(refusals) == len(given) and len(set(map(str, refusals.values()))) == 1:
        raise first
    raise type(first)(f"in the cell {cell_name(points[index])}: {first}") from first


def cell_name(point: Point) -> str:
    """Name a cell by what tells it from the others."""
    masked = redact({key: _number(text) for key, text in point.swept.items()})
    shown = [f"{key}={MASK if masked[key] == MASK else text}" for key, text in point.swept.items()]
    return " ".join([*shown, *point.removed]) or "with nothing removed"


def _number(text: str) -> object:
    """A number as such: it gives nothing away, whatever its key is called."""
    try:
        return float(text)
    except ValueError:
        return text


def _plain(value: object) -> str:
    return value if isinstance(value, str) else json.dumps(value, default=str)
